// SPDX-License-Identifier: Apache-2.0
//
// frame_in_node.js BUILD PAGE FOLDER SIZE TURNS: renders the scene of a folder by the worker of
// pages, at SIZE × SIZE pixels, and prints JSON: seconds until the worker is ready, of the first
// picture and of each exact one; the camera turns between them.
'use strict';
const fs = require('fs');
const path = require('path');
const [build, page, folder, size, turns] = process.argv.slice(2);
const {WorkerInNode} = require(path.join(path.dirname(page), 'worker_in_node.js'));

const begin = performance.now();
const since = () => (performance.now() - begin) / 1000;
const result = {first: null, exact: [], coarse: [], largest_error: 0, over: 0};
const worker = new WorkerInNode(build, page, (message) => {
  if (message.ready) {
    result.ready = since();
    worker.send({type: 'size', width: Number(size), height: Number(size)});
  } else if (message.ended || message.type === 'error') {
    console.error(message.ended ?? message.message);
    process.exit(1);
  } else if (message.type === 'frame') {
    result.first ??= since();
    if (message.state !== 'exact') {
      result.coarse.push({stride: message.stride, seconds: message.seconds});
      return;
    }
    result.exact.push(message.seconds);
    result.largest_error = Math.max(result.largest_error, message.largest_error);
    result.over += message.over;
    if (result.exact.length > Number(turns)) {
      console.log(JSON.stringify(result));
      process.exit(0);
    }
    worker.send({type: 'turn', x: 0.05, y: 0.01});
  }
});
worker.start(fs.readdirSync(folder).map((name) =>
  ({name, bytes: new Uint8Array(fs.readFileSync(path.join(folder, name)))})));
