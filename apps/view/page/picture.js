// SPDX-License-Identifier: Apache-2.0
import {followDrag, newGesture} from './elements.js';
import {drawOverlay} from './overlay.js';

/** Shows frames, and turns what the user does on them into commands. */
export class Picture {
  /** @param {import('./connection.js').Connection} connection */
  constructor(connection) {
    this.connection = connection;
    this.stage = document.getElementById('stage');
    this.canvas = document.getElementById('picture');
    this.errors = document.getElementById('errors');
    this.overlay = document.getElementById('overlay');
    /** Pixels of the last frame as they came, which may be fewer than those of the picture. */
    this.coarse = new OffscreenCanvas(1, 1);
    this.frame = null;
    this.probed = null;
    /** More shapes over the picture, and who is told of clicks on it; both may be missing. */
    this.marks = this.onclick = null;
    new ResizeObserver(() => this.resize()).observe(this.stage);
    matchMedia(`(resolution: ${devicePixelRatio}dppx)`)
      .addEventListener('change', () => this.resize());
    this.addPointer();
    this.addKeys();
  }

  /** Asks for pictures of the size of the stage, in device pixels. */
  resize() {
    const {width, height} = this.stage.getBoundingClientRect();
    if (width < 1 || height < 1) return;
    const pixels = (length) => Math.max(1, Math.min(8192, Math.round(length * devicePixelRatio)));
    this.connection.sendSoon('size', {type: 'size', width: pixels(width), height: pixels(height)});
    this.placeCanvases();
    this.drawOverlay();
  }

  /** The picture fills the stage, unless another page asked for another shape. */
  placeCanvases() {
    if (!this.frame) return;
    const stage = this.stage.getBoundingClientRect();
    const {width, height} = this.frame;
    const scale = Math.min(stage.width / width, stage.height / height);
    for (const element of [this.canvas, this.errors, this.overlay]) {
      element.style.width = `${width * scale}px`;
      element.style.height = `${height * scale}px`;
      element.style.left = `${(stage.width - width * scale) / 2}px`;
      element.style.top = `${(stage.height - height * scale) / 2}px`;
    }
    this.scale = scale;
  }

  /** @param {Object} frame a message "frame" */
  show(frame) {
    this.frame = frame;
    const {width, height, columns, rows, stride} = frame;
    const bytes = columns * rows * 4;
    const data = new ImageData(frame.bytes.subarray(0, bytes), columns, rows);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    const context = this.canvas.getContext('2d', {alpha: false});
    if (stride === 1) {
      context.putImageData(data, 0, 0);
    } else {
      this.coarse.width = columns;
      this.coarse.height = rows;
      this.coarse.getContext('2d').putImageData(data, 0, 0);
      context.imageSmoothingEnabled = true;
      context.imageSmoothingQuality = 'high';
      // A coarse pixel is the upper left one of those that it stands for.
      const shift = (1 - stride) / 2;
      context.drawImage(this.coarse, shift, shift, columns * stride, rows * stride);
    }
    this.errors.hidden = !frame.error_map;
    if (frame.error_map) {
      this.errors.width = width;
      this.errors.height = height;
      this.errors.getContext('2d')
        .putImageData(new ImageData(frame.bytes.subarray(bytes), width, height), 0, 0);
    }
    this.placeCanvases();
    this.drawOverlay();
  }

  drawOverlay() {
    if (!this.frame || !(this.scale > 0)) return;  // a stage that is hidden has no size
    drawOverlay(this.overlay, this.frame, this.scale, this.probed, (clip, handle, event) =>
      this.dragHandle(clip, handle, event), this.marks);
  }

  /** @param {?{x: number, y: number}} at fractions of the picture */
  markProbe(at) {
    this.probed = at;
    this.drawOverlay();
  }

  /** Where an event is, in fractions of the picture's width and height. */
  positionOf(event) {
    const box = this.canvas.getBoundingClientRect();
    return {x: (event.clientX - box.left) / box.width, y: (event.clientY - box.top) / box.height};
  }

  /** Sends a move of the camera; moves that wait are added up. */
  move(type, x, y) {
    this.connection.sendSoon(type, {type, x, y}, (older, newer) =>
      ({type, x: older.x + newer.x, y: older.y + newer.y}));
  }

  zoom(factor) {
    this.connection.sendSoon('zoom', {type: 'zoom', factor}, (older, newer) =>
      ({type: 'zoom', factor: Math.min(90, Math.max(0.02, older.factor * newer.factor))}));
  }

  roll(degrees) {
    this.connection.sendSoon('roll', {type: 'roll', degrees}, (older, newer) =>
      ({type: 'roll', degrees: (older.degrees + newer.degrees) % 360}));
  }

  addPointer() {
    /** @type {Map<number, PointerEvent>} */
    const pointers = new Map();
    const height = () => this.canvas.getBoundingClientRect().height;
    this.canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    this.canvas.addEventListener('pointerdown', (event) => {
      pointers.set(event.pointerId, event);
      this.dragging = true;
      followDrag(event, (next) => {
        const last = pointers.get(next.pointerId);
        const x = (next.clientX - last.clientX) / height();
        const y = (next.clientY - last.clientY) / height();
        if (pointers.size >= 2) this.pinch(pointers, next, height());
        else if (event.button === 2 || (event.button === 0 && event.ctrlKey)) this.zoom(4 ** -y);
        else if (event.button === 1 || event.shiftKey) this.move('pan', x, y);
        else if (event.altKey) this.roll(-180 * x);
        else this.move('turn', x, y);
        pointers.set(next.pointerId, next);
      }, (last) => {
        const isAlone = pointers.size === 1 && event.button === 0;
        pointers.delete(event.pointerId);
        // What moves less is a click.
        const far = Math.hypot(last.clientX - event.clientX, last.clientY - event.clientY);
        const at = this.positionOf(last);
        const isOnIt = at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1;
        if (isAlone && far < 4 && isOnIt && last.type === 'pointerup') this.onclick?.(at);
        this.dragging = pointers.size > 0;
      });
    });
    this.canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
      this.zoom(1.0015 ** (-event.deltaY * lines));
    }, {passive: false});
    this.canvas.addEventListener('dblclick', (event) => {
      const {x, y} = this.positionOf(event);
      if (x >= 0 && x <= 1 && y >= 0 && y <= 1) this.connection.send({type: 'center', x, y});
    });
    let timer = 0;
    this.canvas.addEventListener('pointermove', (event) => {
      clearTimeout(timer);
      if (this.dragging || event.pointerType === 'touch') return;
      timer = setTimeout(() => {
        const {x, y} = this.positionOf(event);
        if (x >= 0 && x <= 1 && y >= 0 && y <= 1) this.connection.send({type: 'probe', x, y});
      }, 80);
    });
    this.canvas.addEventListener('pointerleave', () => clearTimeout(timer));
  }

  /** Two fingers move, zoom and turn the picture. */
  pinch(pointers, next, height) {
    const other = [...pointers.values()].find((event) => event.pointerId !== next.pointerId);
    const last = pointers.get(next.pointerId);
    const before = [last.clientX - other.clientX, last.clientY - other.clientY];
    const after = [next.clientX - other.clientX, next.clientY - other.clientY];
    const length = Math.hypot(...before);
    if (length < 1 || Math.hypot(...after) < 1) return;
    this.zoom(Math.hypot(...after) / length);
    const turned = Math.atan2(after[0] * before[1] - after[1] * before[0],
      after[0] * before[0] + after[1] * before[1]);
    this.roll(-turned * 180 / Math.PI);
    this.move('pan', (next.clientX - last.clientX) / 2 / height,
      (next.clientY - last.clientY) / 2 / height);
  }

  addKeys() {
    const step = 1 / 24;
    const arrows = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step],
      ArrowDown: [0, step]};
    const others = {
      '+': () => this.zoom(1.15), '=': () => this.zoom(1.15), '-': () => this.zoom(1 / 1.15),
      '[': () => this.roll(5), ']': () => this.roll(-5),
    };
    this.canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key in arrows) this.move(event.shiftKey ? 'pan' : 'turn', ...arrows[event.key]);
      else if (event.key in others) others[event.key]();
      else return;
      event.preventDefault();
    });
  }

  dragHandle(clip, handle, event) {
    event.preventDefault();
    const gesture = newGesture();
    const {height} = this.canvas.getBoundingClientRect();
    let last = event;
    // The overlay is drawn anew with each frame, so that the stage follows the drag.
    const stage = this.stage;
    const send = (x, y) => this.connection.sendSoon('handle',
      {type: 'handle', clip, handle, x, y, gesture}, (older, newer) =>
        ({...newer, x: older.x + newer.x, y: older.y + newer.y}));
    const move = (next) => {
      send((next.clientX - last.clientX) / height, (next.clientY - last.clientY) / height);
      last = next;
    };
    const end = () => {
      stage.removeEventListener('pointermove', move);
      for (const name of ['pointerup', 'pointercancel']) window.removeEventListener(name, end);
      this.dragging = false;
    };
    this.dragging = true;
    stage.addEventListener('pointermove', move);
    for (const name of ['pointerup', 'pointercancel']) window.addEventListener(name, end);
  }
}
