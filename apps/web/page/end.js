// SPDX-License-Identifier: Apache-2.0

// The other end of a page that is one file: a worker with the renderer. The page's own files are in
// elements of it, in base 64 (apps/web/make_page.py).

export const isProgram = false;

const needed = 'It takes WebAssembly with SIMD and exceptions: Chrome or Edge 97, Firefox 113, ' +
  'Safari 16.4, or later.';

function bytesOf(element) {
  const text = atob(element.textContent.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export function embeddedFiles() {
  return [...document.querySelectorAll('script[data-embedded]')].map((element) =>
    ({name: element.dataset.embedded, size: Number(element.dataset.size),
      bytes: () => bytesOf(element)}));
}

export function embeddedNote() {
  const element = document.getElementById('embedded-note');
  return element ? new TextDecoder().decode(bytesOf(element)) : '';
}

/** What is wrong with the page or the browser, in a sentence; empty: nothing. */
function trouble(module) {
  if (!document.getElementById('embedded-end')) {
    return 'This page is cut off: its file is not complete. Copy or download it again.';
  }
  if (typeof WebAssembly !== 'object' || !WebAssembly.validate(module)) {
    return `This browser cannot show this page. ${needed}`;
  }
  return '';
}

/** The worker, as a socket is. */
class WorkerSocket extends EventTarget {
  constructor() {
    super();
    this.readyState = WebSocket.CONNECTING;
    this.answers = new Map();
    this.begin().catch((error) => this.end(error.message));
  }

  async begin() {
    let module = null;
    try {
      module = await inflated(bytesOf(document.getElementById('module')));
    } catch {
      throw new Error(document.getElementById('embedded-end') && typeof DecompressionStream !==
        'function' ? `This browser cannot show this page. ${needed}`
        : 'This page is cut off or damaged: its file is not as it was. Copy or download it again.');
    }
    const why = trouble(module);
    if (why) throw new Error(why);
    const script = [document.getElementById('glue'), document.getElementById('worker')]
      .map(({textContent}) => textContent).join('\n');
    const address = URL.createObjectURL(new Blob([script], {type: 'text/javascript'}));
    this.worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker.onmessage = ({data}) => this.receive(data);
    this.worker.onerror = (event) => this.end(event.message);
    const files = embeddedFiles().map(({name, size, bytes}) => ({name, size, bytes: bytes()}));
    for (const {name, size, bytes} of files) {
      if (bytes.length !== size) throw new Error(`${name}: is damaged in this page. Copy it again.`);
    }
    this.worker.postMessage({module, files},
      [module.buffer, ...files.map(({bytes}) => bytes.buffer)]);
  }

  receive(data) {
    if (typeof data === 'string' || data instanceof ArrayBuffer) {
      this.dispatchEvent(new MessageEvent('message', {data}));
    } else if (data.ready) {
      this.readyState = WebSocket.OPEN;
      this.dispatchEvent(new Event('open'));
    } else if (data.ended) {
      this.end(data.ended);
    } else if (data.copied) {
      this.answers.get(data.copied)?.(data.error);
      this.answers.delete(data.copied);
    }
  }

  send(text) { this.worker?.postMessage(text); }

  copy(path, bytes) {
    const number = this.copies = (this.copies ?? 0) + 1;
    return new Promise((resolve, reject) => {
      this.answers.set(number, (error) => (error ? reject(new Error(error)) : resolve()));
      this.worker.postMessage({number, path, bytes}, [bytes.buffer]);
    });
  }

  end(why) {
    if (this.readyState === WebSocket.CLOSED) return;
    this.readyState = WebSocket.CLOSED;
    this.worker?.terminate();
    for (const answer of this.answers.values()) answer(why);
    this.answers.clear();
    this.dispatchEvent(Object.assign(new Event('close'), {reason: why}));
  }
}

let socket = null;

export function openSocket() {
  socket = new WorkerSocket();
  return socket;
}

export async function sendFile(set, name, file, progress) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const size = bytes.length;
  await socket.copy(`/uploads/${set}/${name}`, bytes);
  progress(size);
}
