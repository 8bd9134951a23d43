// An instance of the studio that does its work. The first message is the module, the others are tasks.

import init, { work } from "./studio.js";

const waiting = [];
let isReady = false;

onmessage = async ({ data }) => {
  if (isReady) return work(data);
  if (!(data instanceof WebAssembly.Module)) return waiting.push(data);
  await init({ module_or_path: data });
  isReady = true;
  waiting.splice(0).forEach((message) => work(message));
};
