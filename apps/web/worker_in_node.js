// SPDX-License-Identifier: Apache-2.0
//
// Runs the worker of pages that are one file (apps/web) in Node, as a page does in a browser.
'use strict';
const fs = require('fs');
const path = require('path');
const vm = require('vm');

/** The worker of a build, with the files of a scene. */
class WorkerInNode {
  /**
   * @param {string} build folder with pellucid_worker.js and pellucid_worker.wasm
   * @param {string} page folder with worker.js
   * @param {function(Object): void} receive called with each message: an object, with `bytes`
   */
  constructor(build, page, receive) {
    const channel = new MessageChannel();
    this.channel = channel;
    const scope = {
      postMessage: (data) => receive(parse(data)),
      MessageChannel: class { constructor() { return channel; } },
      TextEncoder, TextDecoder, WebAssembly, console, performance, URL, Uint8Array, process,
      require, __dirname: build, __filename: path.join(build, 'pellucid_worker.js'),
      setTimeout, clearTimeout, Buffer,
    };
    scope.globalThis = scope;
    this.scope = vm.createContext(scope);
    for (const file of [path.join(build, 'pellucid_worker.js'), path.join(page, 'worker.js')]) {
      vm.runInContext(fs.readFileSync(file, 'utf8'), this.scope, {filename: file});
    }
    this.module = fs.readFileSync(path.join(build, 'pellucid_worker.wasm'));
  }
  /** @param {{name: string, bytes: Uint8Array}[]} files */
  start(files) { this.scope.onmessage({data: {module: new Uint8Array(this.module), files}}); }
  send(message) { this.scope.onmessage({data: JSON.stringify(message)}); }
  copy(number, path, bytes) { this.scope.onmessage({data: {number, path, bytes}}); }
  end() { this.channel.port1.close(); }
}

function parse(data) {
  if (typeof data === 'string') return JSON.parse(data);
  if (Object.prototype.toString.call(data) !== '[object ArrayBuffer]') return data;
  const length = new DataView(data).getUint32(0, true);
  const message = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
  message.bytes = new Uint8Array(data, 4 + length);
  return message;
}

module.exports = {WorkerInNode};
