// Messages: errors on top of the map, and what a screen reader says.

const box = document.getElementById("message");
const spoken = document.getElementById("spoken");
let timer;

/** Shows an error for some seconds. */
export function complain(error) {
  if (error.name === "AbortError") return;
  box.textContent = error.message ?? String(error);
  box.hidden = false;
  clearTimeout(timer);
  timer = setTimeout(() => { box.hidden = true; }, 12000);
}

/** Says something to a screen reader. */
export function say(text) {
  spoken.textContent = text;
}

box.addEventListener("click", () => { box.hidden = true; });
