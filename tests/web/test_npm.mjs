// SPDX-License-Identifier: Apache-2.0
//
// The package for authors of other pages, in Node: test_npm.mjs PACKAGE PROGRAM FOLDER
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import {pathToFileURL} from 'node:url';

const [folder, program] = [process.env.PELLUCID_NPM, process.env.PELLUCID_PROGRAM];
const {load} = await import(pathToFileURL(path.join(folder, 'index.js')));
const pellucid = await load();

const sides = [14, 18, 22];
const data = Float32Array.from({length: sides[0] * sides[1] * sides[2]}, (_, i) => {
  const x = i % 22 - 10, y = Math.floor(i / 22) % 18 - 8, z = Math.floor(i / (22 * 18)) - 6.5;
  return Math.exp(-(x * x + y * y + 2 * z * z) / 50);
});
const scene = {layers: [{
  field: {file: 'ball', spacing: [1, 1, 1.5]},
  transfer_function: {points: [{value: 0.2, extinction: 0, color: [0.2, 0.4, 1]},
    {value: 1, extinction: 0.6, color: [1, 0.8, 0.5]}]}}],
camera: {position: [40, -60, 50], focal_point: [10, 9, 10], up: [0, 0, 1], vertical_angle: 30}};

test('a picture is within both tolerances of the program\'s', () => {
  const tolerance = 1e-3;
  const picture = pellucid.render(scene, {ball: {data, shape: sides}},
    {width: 90, height: 70, tolerance});
  assert.equal(picture.rgba.length, 4 * 90 * 70);
  assert.equal(picture.error.length, 90 * 70);
  assert.equal(picture.pixelsOver, 0);
  assert.ok(picture.largestError > 0 && picture.largestError <= tolerance);
  assert.ok(Math.max(...picture.error) <= tolerance);
  const scratch = fs.mkdtempSync('/tmp/pellucid_npm_');
  try {
    fs.writeFileSync(path.join(scratch, 'ball.raw'), data);
    const here = structuredClone(scene);
    Object.assign(here.layers[0].field, {file: 'ball.raw', dimensions: [22, 18, 14], type: 'f32'});
    fs.writeFileSync(path.join(scratch, 'scene.json'), JSON.stringify(here));
    execFileSync(program, ['render', 'scene.json', '--size', '90x70', '--tolerance',
      String(tolerance / 10), '-o', 'ours.exr', '-q'], {cwd: scratch});
    // The picture as an image that the program compares with its own.
    const json = execFileSync('/usr/bin/python3', ['-c', `
import json, sys
import pellucid
image = pellucid.read_image("ours.exr")
print(json.dumps([float(x) for x in image.rgba.reshape(-1)]))`],
    {cwd: scratch, env: {...process.env}, maxBuffer: 1 << 28});
    const ours = JSON.parse(json);
    let worst = 0;
    for (let i = 0; i < ours.length; ++i) {
      const off = Math.abs(ours[i] - picture.rgba[i]);
      assert.ok(off <= picture.error[i >> 2] + tolerance / 10 + 1e-6, `pixel ${i >> 2}: ${off}`);
      worst = Math.max(worst, off);
    }
    assert.ok(ours.some((x) => x > 0.2));
    console.log(`largest difference ${worst}`);
  } finally {
    fs.rmSync(scratch, {recursive: true});
  }
});

test('arrays of every type give the same picture', () => {
  const small = Array.from(data, (x) => Math.round(100 * x));
  const wide = structuredClone(scene);
  for (const point of wide.layers[0].transfer_function.points) point.value *= 100;
  const pictures = [Uint8Array, Int8Array, Uint16Array, Int16Array, Uint32Array, Int32Array,
    Float32Array, Float64Array].map((Type) =>
    pellucid.render(wide, {ball: {data: Type.from(small), shape: sides}}, {width: 40, height: 30}));
  for (const {rgba} of pictures) {
    for (let i = 0; i < rgba.length; ++i) {
      assert.ok(Math.abs(rgba[i] - pictures[0].rgba[i]) <= 2 / 512);
    }
  }
});

test('what is wrong is told in a line', () => {
  const cases = [
    [scene, {}, {}, /ball/],
    [scene, {ball: {data, shape: [14, 18, 21]}}, {}, /7|values/],
    [scene, {ball: {data: [1, 2], shape: [1, 1, 2]}}, {}, /type/],
    [{layers: []}, {}, {}, /layers/],
    [scene, {ball: {data, shape: sides}}, {width: 10}, /both/],
    [scene, {'../x': {data, shape: sides}}, {}, /plain/],
    [{layers: [{field: {file: 'a.nii'}}]}, {'a.nii': new Uint8Array(400)}, {}, /a\.nii/]];
  for (const [wrong, arrays, options, words] of cases) {
    assert.throws(() => pellucid.render(wrong, arrays, options),
      (error) => words.test(error.message) && !error.message.includes('\n'), String(words));
  }
  // And nothing of them is left behind.
  const picture = pellucid.render({layers: [{field: {builtin: 'sphere', points: 16}}]}, {},
    {width: 20, height: 20});
  assert.equal(picture.pixelsOver, 0);
});
