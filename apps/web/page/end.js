// SPDX-License-Identifier: Apache-2.0

// The other end of a page that is one file: a worker with the renderer, or in a notebook whose kernel
// answers, the viewer there (python/pellucid/_notebook.py). The page's own files are in elements of
// it, in base 64 (apps/web/make_page.py).

export const isProgram = false;
/** Milliseconds in which a kernel answers that is to be used in the place of a worker. */
const longestSilence = 3000;
/** Milliseconds in which threads are there that are to be used in the place of one. */
const longestStart = 15000;

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

/** The other end, as a socket is. Its events are those of a WebSocket. */
class EndSocket extends EventTarget {
  constructor() {
    super();
    this.readyState = WebSocket.CONNECTING;
  }

  receive(data) { this.dispatchEvent(new MessageEvent('message', {data})); }

  open() {
    this.readyState = WebSocket.OPEN;
    this.dispatchEvent(new Event('open'));
  }

  end(reason) {
    if (this.readyState === WebSocket.CLOSED) return;
    this.readyState = WebSocket.CLOSED;
    this.dispatchEvent(Object.assign(new Event('close'), {reason}));
  }
}

/** The renderer with threads, where the page has it and its server lets it share memory. */
function threadedRenderer() {
  const [glue, worker] = ['threads-glue', 'threads-worker']
    .map((id) => document.getElementById(id)?.textContent);
  return self.crossOriginIsolated && worker ? {glue, worker} : null;
}

/** A worker that renders in this page. */
class WorkerSocket extends EndSocket {
  constructor() {
    super();
    this.answers = new Map();
    this.timer = 0;  // while threads are waited for
    this.begin(threadedRenderer()).catch((error) => this.end(error.message));
  }

  /** @param {?{glue: string, worker: string}} threads null: without */
  async begin(threads) {
    const prefix = threads ? 'threads-' : '';
    let module = null;
    try {
      module = await inflated(bytesOf(document.getElementById(`${prefix}module`)));
    } catch {
      throw new Error(document.getElementById('embedded-end') && typeof DecompressionStream !==
        'function' ? `This browser cannot show this page. ${needed}`
        : 'This page is cut off or damaged: its file is not as it was. Copy or download it again.');
    }
    const why = trouble(module);
    if (why) throw new Error(why);
    const script = [`${prefix}glue`, 'worker'].map((id) => document.getElementById(id))
      .map(({textContent}) => textContent).join('\n');
    const address = URL.createObjectURL(new Blob([script], {type: 'text/javascript'}));
    this.worker = new Worker(address);
    URL.revokeObjectURL(address);
    this.worker.onmessage = ({data}) => this.answer(data);
    this.worker.onerror = (event) => (this.timer ? this.goOnWithoutThreads()
      : this.end(event.message));
    if (threads) this.timer = setTimeout(() => this.goOnWithoutThreads(), longestStart);
    const files = embeddedFiles().map(({name, size, bytes}) => ({name, size, bytes: bytes()}));
    for (const {name, size, bytes} of files) {
      if (bytes.length !== size) throw new Error(`${name}: is damaged in this page. Copy it again.`);
    }
    this.worker.postMessage({module, files, threads},
      [module.buffer, ...files.map(({bytes}) => bytes.buffer)]);
  }

  answer(data) {
    if (typeof data === 'string' || data instanceof ArrayBuffer) {
      this.receive(data);
    } else if (data.ready) {
      this.stopTimer();
      document.body.dataset.threads = data.threads;
      this.open();
    } else if (data.withoutThreads) {
      this.goOnWithoutThreads();
    } else if (data.ended) {
      this.end(data.ended);
    } else if (data.copied) {
      this.answers.get(data.copied)?.(data.error);
      this.answers.delete(data.copied);
    }
  }

  stopTimer() {
    clearTimeout(this.timer);
    this.timer = 0;
  }

  goOnWithoutThreads() {
    this.stopTimer();
    this.worker.terminate();
    this.begin(null).catch((error) => this.end(error.message));
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
    this.stopTimer();
    this.worker?.terminate();
    for (const answer of this.answers.values()) answer(why);
    this.answers.clear();
    super.end(why);
  }
}

/** What a notebook says of this frame: the viewer, and whether its data are in the kernel alone. */
const frame = /^pellucid:(?<viewer>\w+)(?<away>:away)?$/.exec(self.name)?.groups;

/** The kernel of the notebook around this frame (Jupyter Notebook 6); null: there is none. */
function kernelAround() {
  try {
    return (frame && parent.Jupyter?.notebook?.kernel) ?? null;
  } catch {
    return null;  // of another origin
  }
}

/** A viewer in a kernel, through its notebook: no port of the kernel's machine is needed. */
class KernelSocket extends EndSocket {
  constructor(kernel) {
    super();
    this.comm = kernel.comm_manager.new_comm('pellucid.viewer', {viewer: frame.viewer});
    this.comm.on_msg(({content, buffers}) => this.answer(content.data, buffers ?? []));
    const gone = () => this.end('The kernel of this notebook does not show this scene any more. ' +
      'Run the cell again.');
    this.comm.on_close(gone);
    kernel.events.on('kernel_restarting.Kernel kernel_dead.Kernel', gone);
    addEventListener('pagehide', () => {
      kernel.events.off('kernel_restarting.Kernel kernel_dead.Kernel', gone);
      this.close();
    });
  }

  answer({text, ready}, [bytes]) {
    if (ready) {
      this.open();
    } else if (text !== undefined) {
      this.receive(text);
    } else {
      // Bytes of messages stand in the middle of memory that several have.
      this.receive(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
    }
  }

  send(text) { this.comm.send({text}); }

  copy() {
    return Promise.reject(new Error('This frame shows data of the kernel: open a file in a cell, ' +
      'by pellucid.view().'));
  }

  close() {
    try {
      this.comm.close();
    } catch {
      // The kernel is gone.
    }
  }
}

/** The kernel where it answers, else a worker. */
class ChosenSocket extends EndSocket {
  constructor() {
    super();
    const kernel = kernelAround();
    try {
      if (kernel) return void this.ask(kernel);
    } catch {
      // It is not connected.
    }
    this.work();
  }

  /** Passes on what the other end has to say. @param {EndSocket} end */
  take(end) {
    this.other = end;
    end.addEventListener('message', ({data}) => this.receive(data));
    end.addEventListener('open', () => this.open());
    end.addEventListener('close', ({reason}) => this.end(reason));
  }

  ask(kernel) {
    const socket = new KernelSocket(kernel);
    // Only a worker can take the place of a kernel that is busy or does not know the viewer.
    const timer = frame.away ? 0 : setTimeout(() => socket.end(), longestSilence);
    const first = new AbortController();
    socket.addEventListener('open', () => {
      clearTimeout(timer);
      first.abort();
      this.take(socket);
      this.open();
    }, {once: true});
    socket.addEventListener('close', () => {
      clearTimeout(timer);
      socket.close();
      this.work();
    }, {signal: first.signal});
  }

  work() {
    if (frame?.away) {
      // Whoever made this socket hears of its end.
      setTimeout(() => this.end('The data of this frame are in the kernel of its notebook, which ' +
        'does not answer. Run the cell again, or keep them in the notebook: view(…, embed=True).'));
    } else {
      this.take(new WorkerSocket());
    }
  }

  send(text) { this.other?.send(text); }

  copy(path, bytes) { return this.other.copy(path, bytes); }
}

let socket = null;

export function openSocket() {
  socket = new ChosenSocket();
  return socket;
}

export async function sendFile(set, name, file, progress) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const size = bytes.length;
  await socket.copy(`/uploads/${set}/${name}`, bytes);
  progress(size);
}
