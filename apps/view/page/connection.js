// SPDX-License-Identifier: Apache-2.0

/**
 * The WebSocket to the program that serves this page. Messages that come are events whose names are
 * their types: "scene", "frame", "histogram", "probe", "file", "notes", "progress", "error"; and
 * "lost" when the program has ended. `detail` is the message; of a binary one `detail.parts` has
 * its bytes.
 */
export class Connection extends EventTarget {
  constructor() {
    super();
    const address = new URL('socket', location.href);
    address.protocol = 'ws:';
    this.socket = new WebSocket(address);
    this.socket.binaryType = 'arraybuffer';
    this.socket.addEventListener('open', () => this.tell('open', {}));
    this.socket.addEventListener('close', () => this.tell('lost', {}));
    this.socket.addEventListener('message', (event) => this.receive(event.data));
    /** @type {Map<string, Object>} what is sent before the next picture of the screen */
    this.waiting = new Map();
  }

  /** Sends a message at once, behind those that wait. @param {Object} message */
  send(message) {
    this.flush();
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /**
   * Sends a message with the next picture of the screen. A later one with the same key takes its
   * place; `merge` may join the two.
   */
  sendSoon(key, message, merge = (older, newer) => newer) {
    if (this.waiting.size === 0) requestAnimationFrame(() => this.flush());
    const older = this.waiting.get(key);
    this.waiting.set(key, older ? merge(older, message) : message);
  }

  flush() {
    const messages = [...this.waiting.values()];
    this.waiting.clear();
    if (this.socket.readyState !== WebSocket.OPEN) return;
    for (const message of messages) this.socket.send(JSON.stringify(message));
  }

  receive(data) {
    if (typeof data === 'string') {
      const message = JSON.parse(data);
      this.tell(message.type, message);
      return;
    }
    const length = new DataView(data).getUint32(0, true);
    const message = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    message.bytes = new Uint8ClampedArray(data, 4 + length);
    this.tell(message.type, message);
  }

  tell(name, detail) {
    this.dispatchEvent(new CustomEvent(name, {detail}));
  }

  /** @param {string} name @param {function(Object): void} listener */
  on(name, listener) {
    this.addEventListener(name, (event) => listener(event.detail));
  }
}
