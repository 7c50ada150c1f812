// SPDX-License-Identifier: Apache-2.0
import {button, colorInput, cssColor, followDrag, gestureIsActive, labelled, make, makeSvg,
  newGesture, numberInput, replaceKeepingFocus, shortNumber} from './elements.js';
import {Plot} from './plot.js';
import {SpanControls} from './span_controls.js';

/**
 * Edits a function of one variable: its points over the histogram of the values. A click adds a
 * point, a drag moves it, the right button or Delete removes it.
 */
export class CurveEditor {
  /**
   * @param {function(Object, number): void} edit called with the new function and a gesture
   * @param {function(number, number, number): void} moveSurface with index, value and gesture
   * @param {function(Object): void} askSpan asks for the histogram of a span of values
   */
  constructor(edit, moveSurface, askSpan) {
    this.edit = edit;
    this.moveSurface = moveSurface;
    this.plot = new Plot(190, 'Transfer function');
    this.details = make('div', {class: 'row'});
    this.span = new SpanControls(this.plot, {canLogValues: true, draw: () => this.draw(),
      ask: (span) => {
        // With all values all points are shown, too.
        this.showsAll = Boolean(span.all);
        askSpan(span);
      }});
    this.element = make('div', {class: 'list'}, this.plot.element, this.details,
      this.span.element);
    this.selected = 0;
    this.plot.svg.addEventListener('pointerdown', (event) => this.pressBackground(event));
    this.plot.svg.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  /**
   * @param {Object} transferFunction of a scene file, with points
   * @param {?Object} histogram a message "histogram" of one channel
   * @param {Object[]} surfaces the isosurfaces of the layer
   */
  show(transferFunction, histogram, surfaces) {
    if (this.dragging) return;
    this.function = structuredClone(transferFunction);
    this.points = this.function.points;
    this.histogram = histogram;
    this.surfaces = structuredClone(surfaces);
    /** Opacities of a layer, or extinctions. */
    this.key = 'opacity' in this.points[0] ? 'opacity' : 'extinction';
    this.selected = Math.min(this.selected, this.points.length - 1);
    this.fitAxes();
    this.draw();
  }

  /** Shows the values that are counted; without counts those of the points. */
  fitAxes() {
    const axis = this.histogram?.axes[0];
    const values = axis && !this.showsAll ? [] : this.points.map((point) => point.value);
    if (axis) values.push(axis.lower, axis.upper);
    let lower = Math.min(...values), upper = Math.max(...values);
    if (!(lower < upper)) [lower, upper] = [lower - 1, upper + 1];
    const space = this.histogram?.chosen && !this.showsAll ? 0 : (upper - lower) * 0.02;
    this.plot.axes[0] = {lower: lower - space, upper: upper + space};
    const largest = Math.max(...this.points.map((point) => point[this.key]));
    this.top = this.key === 'opacity' ? 1 : largest > 0 ? largest * 1.2 : 1;
    this.span.show([axis && !this.showsAll ? axis : {lower, upper}], ['value']);
  }

  // The axis of the extinction is that of its square root, so that thin haze can be edited too.
  y(height) {
    return this.plot.height - 4 - Math.sqrt(Math.min(height / this.top, 1)) *
      (this.plot.height - 12);
  }
  heightAt(y) {
    const share = (this.plot.height - 4 - y) / (this.plot.height - 12);
    return Math.min(Math.max(share, 0), 1) ** 2 * this.top;
  }

  /** Value, height and color between two points: linear, as the function is. */
  between(i, share) {
    const a = this.points[i], b = this.points[i + 1];
    const mix = (p, q) => p + (q - p) * share;
    const linear = (p) => typeof p === 'string' ? null : p;
    const color = linear(a.color) && linear(b.color)
      ? a.color.map((c, k) => mix(c, b.color[k])) : share < 0.5 ? a.color : b.color;
    return {value: mix(a.value, b.value), height: mix(a[this.key], b[this.key]), color};
  }

  samples() {
    const first = this.points[0], last = this.points[this.points.length - 1];
    const {lower, upper} = this.plot.axes[0];
    const at = (point, value) => ({value, height: point[this.key], color: point.color});
    const list = [at(first, Math.min(lower, first.value))];
    // Some thousand points of an imported table need no steps between them.
    const steps = this.points.length > 100 ? 1 : 12;
    for (let i = 0; i + 1 < this.points.length; ++i) {
      for (let k = 0; k < steps; ++k) list.push(this.between(i, k / steps));
    }
    list.push(at(last, last.value), at(last, Math.max(upper, last.value)));
    return list;
  }

  draw() {
    const {plot} = this;
    const context = plot.begin();
    plot.drawBars(context, this.histogram);
    const samples = this.samples();
    const gradient = context.createLinearGradient(0, 0, plot.width, 0);
    for (const {value, color} of samples) {
      const share = plot.x(value) / plot.width;
      if (share >= 0 && share <= 1) gradient.addColorStop(share, cssColor(color));
    }
    context.beginPath();
    context.moveTo(plot.x(samples[0].value), plot.height);
    for (const {value, height} of samples) context.lineTo(plot.x(value), this.y(height));
    context.lineTo(plot.x(samples[samples.length - 1].value), plot.height);
    context.globalAlpha = 0.55;
    context.fillStyle = gradient;
    context.fill();
    context.globalAlpha = 1;
    const line = samples.map(({value, height}) => `${plot.x(value)},${this.y(height)}`).join(' ');
    plot.svg.replaceChildren(
      ...plot.axisTexts([this.key === 'opacity' ? 'opacity by value' : '√extinction by value']),
      makeSvg('polyline', {class: 'curve', points: line}),
      ...this.surfaceMarks(), ...this.seenMarks(),
      ...this.points.map((point, i) => this.handle(point, i)));
    this.drawDetails();
  }

  handle(point, i) {
    const shape = makeSvg('circle', {class: i === this.selected ? 'point selected' : 'point', r: 6,
      cx: this.plot.x(point.value), cy: this.y(point[this.key]), tabindex: 0, role: 'button',
      'data-point': i,
      'aria-label': `Point ${i + 1}: value ${shortNumber(point.value)}, ${this.key} ` +
        `${shortNumber(point[this.key])}. Arrow keys move it, Delete removes it.`,
      onpointerdown: (event) => this.pressPoint(event, i),
      onfocus: () => { if (this.selected !== i) this.select(i); },
      onkeydown: (event) => this.pressKey(event, i)});
    shape.style.fill = cssColor(point.color);
    return shape;
  }

  select(i) {
    this.selected = i;
    this.plot.svg.querySelectorAll('.point').forEach((shape, k) =>
      shape.classList.toggle('selected', k === i));
    this.drawDetails();
  }

  surfaceMarks() {
    return this.surfaces.flatMap((surface, i) => {
      const x = this.plot.x(surface.value);
      const line = {x1: x, x2: x, y1: 0, y2: this.plot.height};
      const mark = makeSvg('line', {...line, class: 'surface'});
      mark.style.stroke = cssColor(surface.color ?? [1, 1, 1]);
      const hit = makeSvg('line', {...line, class: 'surface-hit', 'data-surface': i,
        onpointerdown: (event) => this.pressSurface(event, i)});
      return [mark, hit];
    });
  }

  /** @param {?number} value that is under the mouse on the picture */
  markSeen(value) {
    this.seen = value;
    this.plot.svg.querySelectorAll('.seen').forEach((mark) => mark.remove());
    this.plot.svg.append(...this.seenMarks());
  }

  seenMarks() {
    if (this.seen === undefined || this.seen === null) return [];
    const x = this.plot.x(this.seen);
    return [makeSvg('line', {class: 'seen', x1: x, x2: x, y1: 0, y2: this.plot.height})];
  }

  drawDetails() {
    if (gestureIsActive()) return;
    const i = this.selected, point = this.points[i];
    const set = (key) => (value, gesture = newGesture()) => {
      this.points[i] = {...point, [key]: value};
      if (key === 'value') this.points[i].value = this.inOrder(i, value);
      this.send(gesture);
    };
    replaceKeepingFocus(this.details,
      labelled('Value', numberInput(point.value, 'Value of the point', set('value'))),
      labelled(this.key === 'opacity' ? 'Opacity' : 'Extinction',
        numberInput(point[this.key], `${this.key} of the point`, set(this.key), {min: 0})),
      colorInput(point.color, 'Color of the point', set('color')),
      button('Remove', () => this.remove(i), {disabled: this.points.length < 2}));
  }

  /** A value between those of the neighbors. */
  inOrder(i, value) {
    const {lower, upper} = this.plot.axes[0];
    const least = 1e-5 * (upper - lower);
    const below = i > 0 ? this.points[i - 1].value + least : -Infinity;
    const above = i + 1 < this.points.length ? this.points[i + 1].value - least : Infinity;
    return below < above ? Math.min(Math.max(value, below), above) : this.points[i].value;
  }

  send(gesture) {
    this.draw();
    this.edit(this.function, gesture);
  }

  move(i, value, height, gesture) {
    this.points[i] = {...this.points[i], value: this.inOrder(i, value),
      [this.key]: Math.max(height, 0)};
    this.send(gesture);
  }

  remove(i) {
    if (this.points.length < 2) return;
    this.points.splice(i, 1);
    this.selected = Math.max(0, Math.min(i, this.points.length - 1));
    this.send(newGesture());
  }

  pressPoint(event, i) {
    event.stopPropagation();
    event.preventDefault();
    if (event.button === 2) return this.remove(i);
    if (event.button === 0) this.dragPoint(event, i, newGesture());
  }

  pressBackground(event) {
    if (event.button !== 0) return;
    event.preventDefault();
    const {x, y} = this.plot.positionOf(event);
    const value = this.plot.valueAt(x);
    let i = this.points.findIndex((point) => point.value > value);
    if (i < 0) i = this.points.length;
    const near = this.points[Math.min(i, this.points.length - 1)];
    const color = i > 0 && i < this.points.length
      ? this.between(i - 1, (value - this.points[i - 1].value) /
          (this.points[i].value - this.points[i - 1].value)).color : near.color;
    this.points.splice(i, 0, {value, [this.key]: this.heightAt(y), color});
    const gesture = newGesture();
    this.selected = i;
    this.send(gesture);
    this.dragPoint(event, i, gesture);
  }

  dragPoint(event, i, gesture) {
    this.selected = i;
    this.dragging = true;
    // The points are drawn anew while they move, so that the plot follows the drag.
    followDrag({currentTarget: this.plot.svg, pointerId: event.pointerId}, (next) => {
      const {x, y} = this.plot.positionOf(next);
      const inside = Math.min(Math.max(x, 0), this.plot.width);
      this.move(i, this.plot.valueAt(inside), this.heightAt(y), gesture);
    }, () => {
      this.dragging = false;
      this.fitAxes();
      this.draw();
      this.plot.svg.querySelector(`[data-point="${i}"]`)?.focus();
    });
    this.draw();
  }

  pressSurface(event, i) {
    event.stopPropagation();
    event.preventDefault();
    const gesture = newGesture();
    this.dragging = true;
    followDrag({currentTarget: this.plot.svg, pointerId: event.pointerId}, (next) => {
      this.surfaces[i].value = this.plot.valueAt(this.plot.positionOf(next).x);
      this.draw();
      this.moveSurface(i, this.surfaces[i].value, gesture);
    }, () => { this.dragging = false; });
  }

  pressKey(event, i) {
    const {lower, upper} = this.plot.axes[0];
    const step = (upper - lower) / (event.shiftKey ? 500 : 100);
    const point = this.points[i];
    const y = this.y(point[this.key]);
    const moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -3],
      ArrowDown: [0, 3]};
    if (event.key === 'Delete' || event.key === 'Backspace') {
      this.remove(i);
    } else if (event.key in moves) {
      const [dv, dy] = moves[event.key];
      const height = dy === 0 ? point[this.key] : this.heightAt(y + dy);
      this.move(i, point.value + dv, height, newGesture());
    } else {
      return;
    }
    event.preventDefault();
    this.plot.svg.querySelector(`[data-point="${this.selected}"]`)?.focus();
  }
}
