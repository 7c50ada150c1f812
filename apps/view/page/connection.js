// SPDX-License-Identifier: Apache-2.0
import {isProgram, openSocket} from './end.js';

/** Messages after which the picture stays as it is. */
const asks = new Set(['probe', 'slice', 'locate', 'save', 'histogram', 'thumbnail', 'export', 'list_file',
  'list_folder', 'open', 'open_upload', 'suggest', 'cancel', 'film', 'save_film', 'cancel_film',
  'film_taken']);
/** Seconds until the next try to reach a program that was lost. */
const longestPause = 15;

/**
 * The way to the program that serves this page, or to its worker (end.js). Messages that come are events whose names are
 * their types: "scene", "frame", "histogram", "probe", "file", "notes", "progress", "error" and
 * others; and "lost" when the connection ends, "change" when something is sent that changes the
 * picture. `detail` is the message; of a binary one `detail.bytes` has its bytes. A lost connection
 * is made again as soon as the program answers; edits are kept until then.
 */
export class Connection extends EventTarget {
  constructor() {
    super();
    /** @type {Map<string, Object>} what is sent before the next picture of the screen */
    this.waiting = new Map();
    /** @type {Map<string, Object>} edits that could not be sent */
    this.kept = new Map();
    this.pause = 1;
    this.connect();
  }

  connect() {
    this.socket = openSocket();
    /** Numbers of messages: sent, the last that changes the picture, the last that is in it. */
    this.sent = this.changed = this.answered = 0;
    this.page = null;
    this.socket.addEventListener('open', () => {
      this.pause = 1;
      this.tell('open', {});
    });
    this.socket.addEventListener('close', ({reason}) => {
      this.tell('lost', {reason});
      if (!isProgram) return;
      setTimeout(() => this.connect(), this.pause * 1000);
      this.pause = Math.min(2 * this.pause, longestPause);
    });
    this.socket.addEventListener('message', (event) => this.receive(event.data));
  }

  isOpen() { return this.socket.readyState === WebSocket.OPEN; }

  /** Whether the picture lacks something that was sent, or is about to be. */
  isAhead() {
    return this.changed > this.answered ||
      [...this.waiting.values()].some(({type}) => !asks.has(type));
  }

  /** Sends a message at once, behind those that wait. @param {Object} message */
  send(message) {
    this.flush();
    this.sendNow(message);
    if (!asks.has(message.type)) this.tell('change', {});
  }

  sendNow(message) {
    if (this.isOpen()) {
      this.socket.send(JSON.stringify(message));
      ++this.sent;
      if (!asks.has(message.type)) this.changed = this.sent;
    } else if (message.type === 'edit') {
      const key = `${message.layer} ${message.key}`;
      this.kept.delete(key);
      this.kept.set(key, message);
    }
  }

  /** Sends the edits that were made while the program was away. @returns {number} of them */
  sendKept() {
    const messages = [...this.kept.values()];
    this.kept.clear();
    for (const message of messages) this.send(message);
    return messages.length;
  }

  /**
   * Sends a message with the next picture of the screen. A later one with the same key takes its
   * place; `merge` may join the two.
   */
  sendSoon(key, message, merge = (older, newer) => newer) {
    if (this.waiting.size === 0) requestAnimationFrame(() => this.flush());
    const older = this.waiting.get(key);
    this.waiting.set(key, older ? merge(older, message) : message);
    if (!asks.has(message.type)) this.tell('change', {});
  }

  flush() {
    const messages = [...this.waiting.values()];
    this.waiting.clear();
    for (const message of messages) this.sendNow(message);
  }

  receive(data) {
    let message = null;
    if (typeof data === 'string') {
      message = JSON.parse(data);
    } else {
      const length = new DataView(data).getUint32(0, true);
      message = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
      message.bytes = new Uint8ClampedArray(data, 4 + length);
    }
    if (message.type === 'start') this.page = message.page;
    this.answered = Math.max(this.answered, message.answered?.[this.page] ?? 0);
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
