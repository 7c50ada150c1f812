// SPDX-License-Identifier: Apache-2.0

// The worker of a page that is one file: gives the module (apps/web/worker.cpp) the page's messages,
// and lets it work between them. `makePellucid` comes before this.
'use strict';

/** Seconds that the module works before it looks for messages. */
const turnSeconds = 0.03;

let module = null;
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

/** Calls a function of the module with a text. */
function withText(text, call) {
  const bytes = new TextEncoder().encode(text);
  const at = module._malloc(bytes.length + 1);
  module.HEAPU8.set(bytes, at);
  module.HEAPU8[at + bytes.length] = 0;
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

async function start({module: binary, files}) {
  module = await makePellucid({wasmBinary: binary, print: () => {}, printErr: () => {}});
  for (const {name, bytes} of files) write(`/scene/${name}`, bytes);
  postMessage({ready: true});
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
