// SPDX-License-Identifier: Apache-2.0

// The worker of a page that is one file: gives the module (apps/web/worker.cpp) the page's messages,
// and lets it work between them. `makePellucid` comes before this.
'use strict';

/** Seconds that the module works before it looks for messages. */
const turnSeconds = 0.03;
/** Bytes of shared memory at the beginning, and at most: the first that the browser grants. */
const firstBytes = 2 ** 26;
const mostBytes = [2 ** 31, 2 ** 30, 2 ** 29];

let module = null;
/** Memory of a module with threads; null: it has none. */
let shared = null;
let waits = false;
const turns = new MessageChannel();

function end(error) {
  const isMemory = /memory|OOM|array length|allocation/i.test(String(error));
  postMessage({ended: isMemory
    ? 'There is not enough memory for this in a page.'
    : `The renderer of this page stopped (${error?.message ?? error}). Please report it.`});
}

/** Has the module work once the messages that are there are read. */
function soon() {
  if (waits) return;
  waits = true;
  turns.port2.postMessage(0);
}

turns.port1.onmessage = () => {
  waits = false;
  try {
    if (module._pellucid_advance(turnSeconds)) soon();
  } catch (error) {
    end(error);
  }
};

/** The module's memory as it is now: a thread may have made it larger. */
function heap() { return shared ? new Uint8Array(shared.buffer) : module.HEAPU8; }

/** Calls a function of the module with a text. */
function withText(text, call) {
  const bytes = new TextEncoder().encode(text);
  const at = module._malloc(bytes.length + 1);
  const memory = heap();
  memory.set(bytes, at);
  memory[at + bytes.length] = 0;
  try {
    call(at, bytes.length);
  } finally {
    module._free(at);
  }
}

function write(path, bytes) {
  module.FS.mkdirTree(path.slice(0, path.lastIndexOf('/')) || '/');
  module.FS.writeFile(path, bytes, {canOwn: true});
}

function sharedMemory() {
  let problem = null;
  for (const bytes of mostBytes) {
    try {
      return new WebAssembly.Memory(
        {initial: firstBytes / 65536, maximum: bytes / 65536, shared: true});
    } catch (error) {
      problem = error;
    }
  }
  throw problem;
}

/** What the module with threads is made with: its threads begin with the same script. */
function threadOptions({glue, worker}) {
  const [script, ofThreads] = [glue, worker].map((text) =>
    new Blob([text], {type: 'text/javascript'}));
  const address = URL.createObjectURL(ofThreads);
  return {wasmMemory: shared, mainScriptUrlOrBlob: script, locateFile: () => address};
}

/** Makes the module. Returns how many threads it has. */
async function makeModule(binary, threads) {
  const options = {wasmBinary: binary, print: () => {}, printErr: () => {}};
  if (threads) {
    shared = sharedMemory();
    Object.assign(options, threadOptions(threads));
  }
  module = await makePellucid(options);
  return module._pellucid_make_threads();
}

async function start({module: binary, files, threads}) {
  let count = 1;
  try {
    count = await makeModule(binary, threads);
  } catch (error) {
    if (!threads) throw error;
    postMessage({withoutThreads: true});
    return;
  }
  for (const {name, bytes} of files) write(`/scene/${name}`, bytes);
  postMessage({ready: true, threads: count});
  const scene = files.some(({name}) => name === 'scene.json') ? '/scene/scene.json' : '';
  withText(scene, (at) => module._pellucid_start(at));
  soon();
}

onmessage = ({data}) => {
  try {
    if (typeof data === 'string') {
      withText(data, (at, size) => module._pellucid_receive(at, size));
      soon();
    } else if (data.module) {
      start(data).catch(end);
    } else {
      let error = '';
      try {
        write(data.path, data.bytes);
      } catch (problem) {
        error = `${data.path.split('/').pop()}: was not copied (${problem.message ?? problem})`;
      }
      postMessage({copied: data.number, error});
    }
  } catch (error) {
    end(error);
  }
};
