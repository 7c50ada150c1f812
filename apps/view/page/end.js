// SPDX-License-Identifier: Apache-2.0

// The other end of the page: here the program that serves it. apps/web has another one of this
// name, a worker, for pages that are one file.

/** Whether the other end is a program, which can be run again. */
export const isProgram = true;

/** @returns {WebSocket} a new way to the other end */
export function openSocket() {
  const address = new URL('socket', location.href);
  address.protocol = 'ws:';
  const socket = new WebSocket(address);
  socket.binaryType = 'arraybuffer';
  return socket;
}

/** Data that the page brought with it. @returns {{name: string, bytes: function(): Uint8Array}[]} */
export function embeddedFiles() { return []; }

/** What is to be told of these data, in a line; empty: nothing. @returns {string} */
export function embeddedNote() { return ''; }

/**
 * Copies a file to the other end.
 * @param {number} set of files that belong together
 * @param {string} name
 * @param {File} file
 * @param {function(number): void} progress called with the bytes that are sent
 */
export function sendFile(set, name, file, progress) {
  const path = name.split('/').map(encodeURIComponent).join('/');
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open('PUT', `upload/${set}/${path}`);
    request.upload.onprogress = (event) => progress(event.loaded);
    request.onload = () => (request.status === 200
      ? resolve() : reject(new Error(request.responseText || `upload: ${request.statusText}`)));
    request.onerror = () =>
      reject(new Error(`${name}: was not copied; is it readable, and the program running?`));
    request.send(file);
  });
}
