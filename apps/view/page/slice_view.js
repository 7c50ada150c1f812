// SPDX-License-Identifier: Apache-2.0
import {followDrag, make, makeSvg, shortNumber} from './elements.js';
import {axisColors, scaleMark, shapesOf} from './overlay.js';
import {planeAxes, rowSign, sliceName} from './slice_geometry.js';

const arrows = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
/** Pixels: what moves less is a click. */
const clickReach = 4;
/** Pixels between the crossing of the lines and their ends, so that the voxel is seen. */
const gap = 7;
/** Pixels of an event that is a wheel's notch by itself, at least; smaller ones are added up. */
const notch = 40, sumOfNotch = 100;
const largestEdge = 4096;

function styled(line, color) {
  line.style.stroke = color;
  return line;
}

/** One slice: its values as they came, in grey by a window, with labels, crosshair and measures. */
export class SliceView {
  /** @param {import('./four_views.js').FourViews} views @param {number} axis that it crosses */
  constructor(views, axis) {
    this.views = views;
    this.axis = axis;
    this.canvas = make('canvas', {tabindex: 0, role: 'img'});
    this.svg = makeSvg('svg', {'aria-hidden': 'true'});
    this.slider = make('input', {type: 'range', step: 'any',
      oninput: () => views.moveTo(axis, views.stepped(axis, Number(this.slider.value), 0))});
    this.slider.addEventListener('keydown', (event) => this.sliderKey(event));
    this.element = make('section', {class: 'slice', 'data-axis': axis}, this.canvas, this.svg,
      this.slider);
    this.picture = new OffscreenCanvas(1, 1);
    /** @type {?Object} the message "slice" that is shown */
    this.slice = null;
    /** Middle of the view in the world, and world units of a pixel of CSS; null: all is shown. */
    this.shown = null;
    new ResizeObserver(() => this.resize()).observe(this.element);
    this.addPointer();
    this.addKeys();
  }

  // --- What is seen.

  get size() {
    const {clientWidth: width, clientHeight: height} = this.element;
    return {width, height};
  }
  isShown() { return this.element.clientWidth > 0 && this.element.clientHeight > 0; }
  get name() { return sliceName(this.axis, this.views.anatomical); }

  /** Middle and scale; those that show all of the data unless the user chose others. */
  place() {
    if (this.shown) return this.shown;
    const {lower, upper} = this.views.viewer.box;
    const {width, height} = this.size;
    const [u, v] = planeAxes(this.axis);
    const margin = 22;
    const scale = Math.max((upper[u] - lower[u]) / Math.max(width - 2 * margin, 20),
      (upper[v] - lower[v]) / Math.max(height - 2 * margin - 20, 20));
    return {middle: [(lower[u] + upper[u]) / 2, (lower[v] + upper[v]) / 2],
      scale: scale > 0 ? scale : 1};
  }

  /** Position in the plane of a pixel of CSS. @returns {number[]} */
  planeAt(x, y) {
    const {middle, scale} = this.place();
    const {width, height} = this.size;
    return [middle[0] + (x - width / 2) * scale,
      middle[1] + rowSign(this.axis, this.views.anatomical) * (y - height / 2) * scale];
  }
  /** Pixel of CSS of a position in the plane. */
  pixelOf(u, v) {
    const {middle, scale} = this.place();
    const {width, height} = this.size;
    return {x: width / 2 + (u - middle[0]) / scale,
      y: height / 2 + rowSign(this.axis, this.views.anatomical) * (v - middle[1]) / scale};
  }
  pixelOfWorld(position) {
    const [u, v] = planeAxes(this.axis);
    return this.pixelOf(position[u], position[v]);
  }
  /** Position in the world of a pointer. */
  worldOf(event) {
    const box = this.canvas.getBoundingClientRect();
    const position = [...this.views.crosshair];
    const plane = this.planeAt(event.clientX - box.left, event.clientY - box.top);
    planeAxes(this.axis).forEach((a, i) => { position[a] = plane[i]; });
    return position;
  }

  fit() {
    this.shown = null;
    this.moved();
  }
  zoom(factor, x = this.size.width / 2, y = this.size.height / 2) {
    const {middle, scale} = this.place();
    const before = this.planeAt(x, y);
    const {upper, lower} = this.views.viewer.box;
    const extent = Math.max(...upper.map((high, a) => high - lower[a])) || 1;
    this.shown = {middle, scale: Math.min(Math.max(scale / factor, extent * 1e-6), extent)};
    const after = this.planeAt(x, y);
    this.shown.middle = middle.map((at, i) => at + before[i] - after[i]);
    this.moved();
  }
  pan(x, y) {
    const {middle, scale} = this.place();
    const sign = rowSign(this.axis, this.views.anatomical);
    this.shown = {scale, middle: [middle[0] - x * scale, middle[1] - sign * y * scale]};
    this.moved();
  }
  moved() {
    this.draw();
    this.ask();
  }

  resize() {
    if (!this.isShown() || !this.views.crosshair) return;
    this.moved();
  }

  // --- What is asked for.

  /** Asks for the slice at the crosshair; one question is out at a time. */
  ask() {
    if (!this.isShown() || !this.views.crosshair) return;
    this.isStale = true;
    if (this.isAsked) return;
    this.isAsked = true;
    this.isStale = false;
    const {width, height} = this.size;
    const pixels = (length) =>
      Math.max(1, Math.min(largestEdge, Math.round(length * devicePixelRatio)));
    const {channel} = this.views;
    this.views.viewer.connection.sendSoon(`slice ${this.axis}`, {type: 'slice', axis: this.axis,
      position: this.views.crosshair[this.axis], from: this.planeAt(0, 0),
      to: this.planeAt(width, height), columns: pixels(width), rows: pixels(height),
      ...(channel ? {layer: channel.layer, channel: channel.channel} : {})});
  }
  /** What was asked may never be answered. */
  askAnew() {
    this.isAsked = false;
    this.ask();
  }

  /** @param {Object} message "slice" */
  receive(message) {
    this.isAsked = false;
    const {columns, rows, bytes} = message;
    const count = columns * rows;
    let at = bytes.byteOffset;
    message.numbers = null;
    if (message.values) {
      message.numbers = new Float32Array(bytes.buffer, at, count);
      at += 4 * count;
    }
    message.indices = message.labels ? new Uint16Array(bytes.buffer, at, count) : null;
    this.slice = message;
    this.compose();
    this.draw();
    if (this.isStale) this.ask();
  }

  /** Paints the values as they came: grey by the window, labels over them. */
  compose() {
    const {slice} = this;
    if (!slice) return;
    const {columns, rows, numbers, indices} = slice;
    const image = new ImageData(columns, rows);
    const {data} = image;
    if (numbers) {
      const [lower, upper] = this.views.windowOf(slice);
      const factor = 255 / (upper - lower);
      for (let i = 0; i < numbers.length; ++i) {
        const value = numbers[i];
        if (value !== value) continue;  // NaN: transparent
        data[4 * i] = data[4 * i + 1] = data[4 * i + 2] = (value - lower) * factor;
        data[4 * i + 3] = 255;
      }
    }
    const share = this.views.labelShare;
    if (indices && share > 0) {
      const colors = [null, ...slice.labels.map(({color}) =>
        [1, 3, 5].map((k) => parseInt(color.slice(k, k + 2), 16)))];
      for (let i = 0; i < indices.length; ++i) {
        const color = colors[indices[i]];
        if (!color) continue;
        const behind = data[4 * i + 3] ? 1 - share : 0;
        for (let k = 0; k < 3; ++k) {
          data[4 * i + k] = behind * data[4 * i + k] + (1 - behind) * color[k];
        }
        data[4 * i + 3] = behind ? 255 : 255 * share;
      }
    }
    this.picture.width = columns;
    this.picture.height = rows;
    this.picture.getContext('2d').putImageData(image, 0, 0);
  }

  // --- What is drawn.

  draw() {
    if (!this.isShown() || !this.views.crosshair) return;
    const {width, height} = this.size;
    const ratio = devicePixelRatio;
    const columns = Math.round(width * ratio), rows = Math.round(height * ratio);
    if (this.canvas.width !== columns || this.canvas.height !== rows) {
      this.canvas.width = columns;
      this.canvas.height = rows;
    }
    const context = this.canvas.getContext('2d');
    context.fillStyle = '#000000';
    context.fillRect(0, 0, columns, rows);
    if (this.slice) {
      const from = this.pixelOf(...this.slice.from), to = this.pixelOf(...this.slice.to);
      const [x, y, w, h] = [from.x, from.y, to.x - from.x, to.y - from.y].map((at) => at * ratio);
      const isSame = Math.abs(x) + Math.abs(y) < 0.01 && Math.abs(w - columns) < 0.6 &&
        Math.abs(h - rows) < 0.6;
      context.imageSmoothingEnabled = !isSame;
      if (isSame) context.drawImage(this.picture, 0, 0);
      else context.drawImage(this.picture, x, y, w, h);
    }
    this.drawMarks(width, height);
    this.tellNames();
  }

  drawMarks(width, height) {
    const {views} = this;
    const {scale} = this.place();
    const [u, v] = planeAxes(this.axis);
    const at = this.pixelOfWorld(views.crosshair);
    this.svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    const line = (x1, y1, x2, y2, axis) => (x1 === x2 && y1 === y2 ? [] : [
      makeSvg('line', {class: 'halo', x1, y1, x2, y2}),
      styled(makeSvg('line', {class: 'cross', x1, y1, x2, y2}), axisColors[axis])]);
    const right = Math.min(width, Math.max(0, at.x + gap)), left = Math.min(width, at.x - gap);
    const below = Math.min(height, Math.max(0, at.y + gap)), above = Math.min(height, at.y - gap);
    // A line has the color of the axis that its own slice crosses.
    const lines = !views.hasLines ? [] : [
      ...line(0, at.y, Math.max(0, left), at.y, v), ...line(right, at.y, width, at.y, v),
      ...line(at.x, 0, at.x, Math.max(0, above), u), ...line(at.x, below, at.x, height, u)];
    const text = (x, y, content, anchor = 'middle') =>
      makeSvg('text', {x, y, 'text-anchor': anchor}, content);
    const {axes} = views.overlay ?? {};
    const letters = [];
    if (axes) {
      const down = rowSign(this.axis, views.anatomical) > 0;
      letters.push(text(10, height / 2, axes[u].minus), text(width - 10, height / 2, axes[u].plus),
        text(width / 2, width < 320 ? 35 : 17, down ? axes[v].minus : axes[v].plus),
        text(width / 2, height - 32, down ? axes[v].plus : axes[v].minus));
    }
    const title = text(8, 17, `${this.name} ${views.numberText(views.crosshair[this.axis])}`,
      'start');
    title.style.fill = axisColors[this.axis];
    // The bar stands above the slider.
    const free = height - 22;
    const bar = Math.min(width, free) > 100
      ? shapesOf(scaleMark({height: free * scale, unit: views.unit}, width, free)) : [];
    this.svg.replaceChildren(...lines, ...letters, title, ...bar,
      ...views.measures.shapes((point) => ({...this.pixelOfWorld(point), isNear:
        Math.abs(point[this.axis] - views.crosshair[this.axis]) <= views.reach(this.axis)})));
  }

  tellNames() {
    const {views} = this;
    const name = `${this.name} slice`;
    this.element.setAttribute('aria-label', name);
    this.canvas.setAttribute('aria-label', `${name} at ` +
      `${views.numberText(views.crosshair[this.axis])}. Arrow keys move the crosshair, page up ` +
      'and down go from slice to slice, plus and minus zoom, shift with arrows moves the ' +
      'picture, 0 shows all, enter sets a point of a measure.');
    this.slider.setAttribute('aria-label', `Position of the ${name.toLowerCase()}`);
    const {lower, upper} = views.viewer.box;
    this.slider.min = lower[this.axis];
    this.slider.max = upper[this.axis];
    this.slider.value = views.crosshair[this.axis];
    this.slider.setAttribute('aria-valuetext', views.numberText(views.crosshair[this.axis]));
  }

  // --- What the user does.

  addPointer() {
    const {canvas, views} = this;
    /** @type {Map<number, PointerEvent>} */
    const pointers = new Map();
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('pointerdown', (event) => {
      if (!views.crosshair) return;
      pointers.set(event.pointerId, event);
      const isPinch = pointers.size > 1;
      if (isPinch) views.measures.forgetLast(this.placed);
      const act = isPinch ? null : this.action(event);
      act?.(event, event);
      followDrag(event, (next) => {
        const last = pointers.get(next.pointerId);
        if (pointers.size > 1) this.pinch(pointers, next);
        else act?.(next, last);
        pointers.set(next.pointerId, next);
      }, (last) => {
        pointers.delete(event.pointerId);
        const far = Math.hypot(last.clientX - event.clientX, last.clientY - event.clientY);
        // A drag from one point to another is two clicks.
        if (this.placed && far > clickReach && pointers.size === 0) {
          views.measures.add(this.worldOf(last));
        }
        this.placed = null;
      });
    });
    canvas.addEventListener('pointermove', (event) => {
      if (pointers.size === 0 && event.pointerType !== 'touch' && views.measures.isBegun()) {
        views.measures.hover(this.worldOf(event));
      }
    });
    canvas.addEventListener('dblclick', () => {
      if (views.tool === 'crosshair') views.enlarge(this.axis);
    });
    let turned = 0;
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const amount = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? notch : 1);
      if (event.ctrlKey || event.metaKey) {
        const box = canvas.getBoundingClientRect();
        this.zoom(1.0015 ** -amount, event.clientX - box.left, event.clientY - box.top);
        return;
      }
      turned = turned * amount < 0 ? amount : turned + amount;
      if (Math.abs(amount) < notch && Math.abs(turned) < sumOfNotch) return;
      views.step(this.axis, turned < 0 ? 1 : -1);
      turned = 0;
    }, {passive: false});
  }

  /** What a drag that begins does: called with each event and the one before it. */
  action(event) {
    const {views} = this;
    const moved = (next, last) => [next.clientX - last.clientX, next.clientY - last.clientY];
    const windowing = (next, last) => {
      const [x, y] = moved(next, last);
      const {width, height} = this.size;
      views.dragWindow(x / width, y / height);
    };
    if (event.button === 2) return windowing;
    if (event.button === 1 || event.shiftKey) return (next, last) => this.pan(...moved(next, last));
    if (event.ctrlKey) return (next, last) => this.zoom(1.01 ** -moved(next, last)[1]);
    if (views.tool === 'window') return windowing;
    if (views.tool === 'crosshair') return (next) => views.setCrosshair(this.worldOf(next));
    return (next) => {
      if (next === event) this.placed = views.measures.add(this.worldOf(next));
      else if (views.measures.isBegun()) views.measures.hover(this.worldOf(next));
      else this.placed = null;
    };
  }

  /** Two fingers zoom and move. */
  pinch(pointers, next) {
    const other = [...pointers.values()].find((event) => event.pointerId !== next.pointerId);
    const last = pointers.get(next.pointerId);
    const length = (event) => Math.hypot(event.clientX - other.clientX,
      event.clientY - other.clientY);
    const box = this.canvas.getBoundingClientRect();
    if (length(last) >= 1 && length(next) >= 1) {
      this.zoom(length(next) / length(last), (next.clientX + other.clientX) / 2 - box.left,
        (next.clientY + other.clientY) / 2 - box.top);
    }
    this.pan((next.clientX - last.clientX) / 2, (next.clientY - last.clientY) / 2);
  }

  addKeys() {
    const {views, axis} = this;
    const others = {
      'PageUp': () => views.step(axis, 1), 'PageDown': () => views.step(axis, -1),
      '+': () => this.zoom(1.25), '=': () => this.zoom(1.25), '-': () => this.zoom(0.8),
      '0': () => this.fit(),
      'Enter': () => views.measures.isOn() && views.measures.add([...views.crosshair]),
    };
    this.canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || !views.crosshair) return;
      if (event.key in arrows) {
        const [x, y] = arrows[event.key];
        const [u, v] = planeAxes(axis);
        if (event.shiftKey) this.pan(-40 * x, -40 * y);
        else if (x) views.step(u, x);
        else views.step(v, rowSign(axis, views.anatomical) * y);
      } else if (event.key in others) {
        others[event.key]();
      } else {
        return;
      }
      event.preventDefault();
    });
  }

  /** The slider goes from slice to slice. */
  sliderKey(event) {
    const by = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: 10,
      PageDown: -10}[event.key];
    if (!by) return;
    this.views.step(this.axis, by);
    event.preventDefault();
  }
}

/** @returns {string} a number with its unit */
export function withUnit(number, unit) {
  return `${shortNumber(number)}${unit ? ' ' + unit : ''}`;
}
