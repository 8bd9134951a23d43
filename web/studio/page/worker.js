// An instance of the studio that does its work, or that lends its thread to another instance.

const folder = new URLSearchParams(location.search).has("threads") ? "./threads/" : "./";
const waiting = [];
let work;

// The first message has the module, and the memory of the instance to which the thread is lent. The others are for that
// instance's work.
onmessage = async ({ data }) => {
  if (work) return work(data);
  if (data[0] !== "begin") return waiting.push(data);
  const [, module, memory] = data;
  const program = await import(`${folder}studio.js`);
  await program.default({ module_or_path: module, memory });
  if (memory) return program.lend();
  work = program.work;
  waiting.splice(0).forEach((message) => work(message));
};
