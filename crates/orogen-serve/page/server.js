// Requests to the server: addresses with the token and the variant of the world.

import { state } from "./state.js";

const own = new URLSearchParams(location.search);

/** The address of a request of this world; of the world of the recipe itself with `isOriginal`. */
export function address(path, parameters = {}, isOriginal = false) {
  const url = new URL(path, new URL("./", document.baseURI.split(/[?#]/)[0]));
  for (const [name, value] of Object.entries(parameters)) url.searchParams.set(name, value);
  if (!isOriginal) vary(url);
  if (own.has("token")) url.searchParams.set("token", own.get("token"));
  return url.href;
}

/** Adds the seed and the changed parameters. */
function vary(url) {
  if (state.seed !== null) url.searchParams.set("seed", state.seed);
  for (const [name, value] of Object.entries(state.set)) url.searchParams.append("set", `${name}=${value}`);
}

/** The JSON answer of a request. An error has the sentence of the server. */
export async function ask(path, parameters, signal, isOriginal = false) {
  const response = await fetch(address(path, parameters, isOriginal), { signal });
  const text = await response.text();
  let answer;
  try {
    answer = JSON.parse(text);
  } catch {
    throw new Error(`${response.status}: ${text.slice(0, 200)}`);
  }
  if (!response.ok) throw new Error(answer.error ?? String(response.status));
  return answer;
}
