"""The controls of a window as a screen reader finds them, by AT-SPI: names, roles, places and states."""

import os
import subprocess
from dataclasses import dataclass, field

from jeepney import DBusAddress, MessageType, new_method_call
from jeepney.io.blocking import open_dbus_connection

REGISTRY = ("org.a11y.atspi.Registry", "/org/a11y/atspi/accessible/root")
ACCESSIBLE, COMPONENT = "org.a11y.atspi.Accessible", "org.a11y.atspi.Component"
PROPERTIES = "org.freedesktop.DBus.Properties"
# Roles and states, by their numbers in AT-SPI.
ROLES = {
    6: "canvas", 7: "check box", 11: "combo box", 23: "window", 29: "label", 39: "panel", 43: "button", 51: "slider",
    52: "number", 61: "text", 62: "button", 79: "text", 88: "link",
}
IN_WINDOW = 1
ENABLED, FOCUSED = 8, 12


@dataclass
class Control:
    """A control of the window."""

    name: str
    role: str
    # Left, top, width and height in the window; None without a place.
    place: tuple | None
    states: int
    children: list = field(default_factory=list)

    def has(self, state):
        return bool(self.states >> state & 1)

    @property
    def middle(self):
        left, top, width, height = self.place
        return left + width // 2, top + height // 2

    def all(self):
        """The control and all below it."""
        yield self
        for child in self.children:
            yield from child.all()


class Bus:
    """A session bus of its own, on which screen readers are said to be in use."""

    def __init__(self, environment):
        # Settings of the desktop are kept in memory.
        environment["GSETTINGS_BACKEND"] = "memory"
        self.process = subprocess.Popen(
            ["dbus-daemon", "--session", "--nofork", "--print-address"],
            env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        )
        self.address = self.process.stdout.readline().strip()
        environment["DBUS_SESSION_BUS_ADDRESS"] = self.address
        self.session = open_dbus_connection(self.address)
        service = ("org.a11y.Bus", "/org/a11y/bus")
        [address] = self.ask(self.session, (service, "org.a11y.Bus", "GetAddress"))[0]
        status = ("org.a11y.Status", "IsEnabled", ("b", True))
        self.ask(self.session, (service, PROPERTIES, "Set", "ssv", status))
        self.connection = open_dbus_connection(address)

    def ask(self, connection, *calls):
        """Sends all calls, then waits for the replies; None in place of an error."""
        waiting = {}
        for n, ((service, path), interface, method, *arguments) in enumerate(calls):
            message = new_method_call(DBusAddress(path, service, interface), method, *arguments)
            serial = next(connection.outgoing_serial)
            connection.send(message, serial=serial)
            waiting[serial] = n
        replies = [None] * len(calls)
        while waiting:
            reply = connection.receive(timeout=60)
            n = waiting.pop(reply.header.fields.get(5), None)
            if n is not None and reply.header.message_type == MessageType.method_return:
                replies[n] = reply.body
        return replies

    def window(self, process):
        """The window of a process, with all controls in it; None if there is none yet."""
        [children] = self.ask(self.connection, (REGISTRY, ACCESSIBLE, "GetChildren"))
        applications = [tuple(at) for at in children[0]] if children else []
        daemon = ("org.freedesktop.DBus", "/org/freedesktop/DBus")
        ask_id = (daemon, "org.freedesktop.DBus", "GetConnectionUnixProcessID", "s")
        ids = self.ask(self.connection, *((*ask_id, (name,)) for name, _ in applications))
        for application, number in zip(applications, ids):
            if number == (process,):
                windows = self.tree(application).children
                return windows[0] if windows else None
        return None

    def tree(self, root):
        """A control and all below it, level by level. Controls that are removed meanwhile are left out."""
        top = Control("", "", None, 0)
        level = [(root, top)]
        while level:
            calls = [
                call
                for at, _ in level
                for call in (
                    (at, PROPERTIES, "Get", "ss", (ACCESSIBLE, "Name")),
                    (at, ACCESSIBLE, "GetRole"),
                    (at, COMPONENT, "GetExtents", "u", (IN_WINDOW,)),
                    (at, ACCESSIBLE, "GetState"),
                    (at, ACCESSIBLE, "GetChildren"),
                )
            ]
            replies = iter(self.ask(self.connection, *calls))
            below = []
            for (_, parent), name, role, place, state, children in zip(level, *[replies] * 5):
                if not name or not role or not children:
                    continue
                states = state[0][0] if state and state[0] else 0
                role = ROLES.get(role[0], str(role[0]))
                control = Control(name[0][1], role, tuple(place[0]) if place else None, states)
                parent.children.append(control)
                below += [(tuple(child), control) for child in children[0]]
            level = below
        return top.children[0] if top.children else top

    def end(self):
        self.connection.close()
        self.session.close()
        self.process.terminate()
        self.process.wait(20)
