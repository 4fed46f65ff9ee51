// Runs the module named on the command line and prints its text; exits with 1 if a job failed.
import { readFileSync, writeSync } from "node:fs";

const module = new WebAssembly.Module(readFileSync(process.argv[2]));
const { run, length, memory } = new WebAssembly.Instance(module, {}).exports;
const text = new TextDecoder().decode(new Uint8Array(memory.buffer, run(), length()));
writeSync(1, text);
process.exit(/^failed /m.test(text) ? 1 : 0);
