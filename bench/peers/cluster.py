#!/usr/bin/env python3
"""A build by Dask workers on this machine, beside the same build in one process: cluster.py PACKAGE SIDE TASKS...

Prints one line of JSON: seconds of wall time of the builds, the memory limit of a worker and the largest memory of one
in MB, and for each number of tasks that do nothing the memory of the scheduler and client in MB, and their seconds of
CPU a task.
"""

import json
import os
import resource
import sys
import tempfile
import time

import dask
import distributed.nanny  # Reads the defaults, which are replaced below.
from distributed import Client, LocalCluster
from orogen import World, cluster

EXTENT = 15360
MEMORY = 512 << 20


def land():
    return World("hills", threads=1, memory=MEMORY, cache=False)


def seconds(function):
    start = time.perf_counter()
    function()
    return time.perf_counter() - start


def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


def memory():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


# Workers with the allocator's own settings, as docs/python.md advises: Dask's cost builds 8 to 14 %.
dask.config.set({"distributed.nanny.pre-spawn-environ": {"OMP_NUM_THREADS": 1}})


def workers(count):
    return LocalCluster(
        n_workers=count, threads_per_worker=1, processes=True, dashboard_address=None, memory_limit=0, silence_logs=40
    )


def nothing(number):
    return number


def main():
    side, tasks = int(sys.argv[2]), [int(count) for count in sys.argv[3:]]
    asked = {"cell": EXTENT / side, "tile": 1024}
    found = {"limit": [MEMORY / 1e6]}
    with tempfile.TemporaryDirectory() as folder:
        found["one process"] = [seconds(lambda: land().build(f"{folder}/local.zarr", **asked))]
        for name, count in (("one worker", 1), ("two workers", 2)):
            with workers(count) as local, Client(local) as client:
                client.wait_for_workers(count)
                client.run(peak)
                path = f"{folder}/{count}.zarr"
                found[name] = [seconds(lambda: cluster.build(land(), path, client=client, **asked))]
                found["worker"] = [max(client.run(peak).values())]
    for count in tasks:
        with workers(2) as local, Client(local) as client:
            client.wait_for_workers(2)
            start = time.process_time()
            for _ in cluster._in_waves(client, nothing, ((number,) for number in range(count)), 0):
                pass
            found[f"CPU, {count}"] = [(time.process_time() - start) / count]
            found[f"memory, {count}"] = [memory()]
    print("\n" + json.dumps(found))


if __name__ == "__main__":
    main()
