// SPDX-License-Identifier: Apache-2.0
import {button, choice, colorInput, cssColor, followDrag, gestureIsActive, labelled, make, makeSvg,
  newGesture, numberInput, replaceKeepingFocus, shortNumber} from './elements.js';
import {ellipseOf, mappedMatrix, planeMatrix, reachOf, stretching, turning, withReach}
  from './ellipse.js';
import {Plot} from './plot.js';
import {SpanControls} from './span_controls.js';

/**
 * Edits a function of several variables: its Gaussians as ellipses over the joint histogram of two
 * of them. A drag moves one, its grips stretch and turn it, a double click makes one, Delete removes
 * it. The outline is where the extinction is 1/e of its peak.
 */
export class GaussianEditor {
  /**
   * @param {function(Object, number): void} edit called with the new function and a gesture
   * @param {function(string[]): void} askHistogram called with the two channels that are shown
   * @param {function(string[], Object): void} askSpan the same, of a span of their values
   */
  constructor(edit, askHistogram, askSpan) {
    this.edit = edit;
    this.askHistogram = askHistogram;
    this.askSpan = askSpan;
    this.plot = new Plot(300, 'Gaussians over the joint histogram');
    this.pair = make('div', {class: 'row'});
    this.details = make('div', {class: 'list'});
    this.span = new SpanControls(this.plot, {canLogValues: false, draw: () => this.draw(),
      ask: (span) => askSpan(this.shown, span)});
    this.element = make('div', {class: 'list'}, this.pair, this.plot.element, this.details,
      this.span.element);
    this.selected = 0;
    this.plot.svg.addEventListener('dblclick', (event) => this.add(event));
    this.plot.svg.addEventListener('contextmenu', (event) => event.preventDefault());
  }

  /**
   * @param {Object} transferFunction of a scene file, with Gaussians as matrices
   * @param {string[]} channels of the layer
   * @param {function(string[]): ?Object} histogramOf finds a message "histogram" of two channels
   */
  show(transferFunction, channels, histogramOf) {
    if (this.dragging) return;
    this.function = structuredClone(transferFunction);
    this.function.gaussians ??= [];
    this.channels = channels;
    if (!this.shown || !this.shown.every((name) => channels.includes(name))) {
      this.shown = [channels[0], channels[Math.min(1, channels.length - 1)]];
    }
    this.histogramOf = histogramOf;
    this.selected = Math.min(this.selected, this.function.gaussians.length - 1);
    this.drawPair();
    this.draw();
  }

  drawPair() {
    const options = this.channels.map((name) => [name, name]);
    const select = (k, text) => labelled(text, choice(this.shown[k], options, `Channel along ${text}`,
      (name) => {
        this.shown[k] = name;
        this.draw();
      }));
    replaceKeepingFocus(this.pair, select(0, 'x'), select(1, 'y'));
  }

  /** Data per unit of the plot. */
  units() {
    const [x, y] = this.plot.axes;
    return [(x.upper - x.lower) / this.plot.width, -(y.upper - y.lower) / this.plot.height];
  }
  toPlot([x, y]) {
    const [ux, uy] = this.units();
    return [(x - this.plot.axes[0].lower) / ux, this.plot.height + (y - this.plot.axes[1].lower) / uy];
  }
  fromPlot(x, y) {
    const [ux, uy] = this.units();
    return [this.plot.axes[0].lower + x * ux, this.plot.axes[1].lower + (y - this.plot.height) * uy];
  }
  /** Where the channels that are shown stand in a Gaussian; null if it lacks one of them. */
  columnsOf(gaussian) {
    const columns = this.shown.map((name) => gaussian.channels.indexOf(name));
    return columns.includes(-1) || columns[0] === columns[1] ? null : columns;
  }

  draw() {
    const {plot} = this;
    const histogram = this.histogramOf(this.shown);
    const context = plot.begin();
    if (histogram) {
      plot.axes = histogram.axes.map(({lower, upper}) => ({lower, upper}));
      plot.drawShades(context, histogram);
      if (!this.dragging) {
        this.span.show(plot.axes, this.shown);
        this.showAll(histogram);
      }
    } else {
      this.askHistogram(this.shown);
    }
    plot.svg.replaceChildren(...plot.axisTexts(this.shown),
      ...this.function.gaussians.flatMap((gaussian, i) => this.shapes(gaussian, i)),
      ...this.seenMarks());
    this.drawDetails();
  }

  /** Asks for a larger span where Gaussians reach out of the middle of the values. */
  showAll(histogram) {
    if (histogram.chosen || histogram === this.extended) return;
    this.extended = histogram;
    const ranges = histogram.axes.map(({lower, upper}) => [lower, upper]);
    let isLarger = false;
    for (const gaussian of this.function.gaussians) {
      const columns = this.columnsOf(gaussian) ?? [];
      columns.forEach((column, k) => {
        const center = gaussian.center[column], reach = reachOf(gaussian.matrix, column) ?? 0;
        isLarger ||= center - reach < ranges[k][0] || center + reach > ranges[k][1];
        ranges[k] = [Math.min(ranges[k][0], center - reach),
          Math.max(ranges[k][1], center + reach)];
      });
    }
    if (isLarger) this.askSpan(this.shown, {ranges});
  }

  shapes(gaussian, i) {
    const columns = this.columnsOf(gaussian);
    if (!columns) return [];
    const [cx, cy] = this.toPlot(columns.map((column) => gaussian.center[column]));
    const {angle, lengths} = ellipseOf(planeMatrix(gaussian.matrix, columns, this.units()));
    const selected = i === this.selected;
    const body = makeSvg('ellipse', {class: selected ? 'ellipse selected' : 'ellipse', cx, cy,
      rx: lengths[0], ry: lengths[1], transform: `rotate(${angle * 180 / Math.PI} ${cx} ${cy})`,
      tabindex: 0, role: 'button', 'data-gaussian': i,
      'aria-label': `Gaussian ${i + 1} at ${gaussian.center.map(shortNumber).join(', ')}. ` +
        'Arrow keys move it, Delete removes it.',
      onpointerdown: (event) => this.pressBody(event, i, columns),
      onfocus: () => { if (this.selected !== i && !this.dragging) this.select(i); },
      onkeydown: (event) => this.pressKey(event, i, columns)});
    body.style.fill = cssColor(gaussian.color);
    if (!selected) return [body];
    const at = (turned, length) => this.inside(cx, cy, angle + turned, length);
    const grip = (name, [x, y], press) => makeSvg(name === 'turn' ? 'circle' : 'rect', {
      class: 'grip', 'data-grip': name, x: x - 5, y: y - 5, width: 10, height: 10, cx: x, cy: y,
      r: 6, onpointerdown: press});
    let [tx, ty] = at(0, lengths[0] + 18);
    const [lx, ly] = at(0, lengths[0]);
    // Where the plot ends between the two, the round grip stands before the square one.
    if (Math.hypot(tx - lx, ty - ly) < 14) [tx, ty] = [(cx + lx) / 2, (cy + ly) / 2];
    const stem = makeSvg('line', {class: 'curve', x1: cx, y1: cy, x2: tx, y2: ty});
    return [body, stem,
      ...[0, 1].map((k) => grip(k === 0 ? 'long' : 'short', at(k * Math.PI / 2, lengths[k]),
        (event) => this.pressStretch(event, i, columns, k))),
      grip('turn', [tx, ty], (event) => this.pressTurn(event, i, columns))];
  }

  /** The end of a half axis, or where it leaves the plot: a grip that is not seen is of no use. */
  inside(cx, cy, angle, length) {
    const edge = 8;
    const reach = (sign) => {
      const dx = sign * Math.cos(angle), dy = sign * Math.sin(angle);
      const along = (d, c, size) =>
        (d > 1e-9 ? (size - edge - c) / d : d < -1e-9 ? (edge - c) / d : Infinity);
      return Math.max(0, Math.min(length, along(dx, cx, this.plot.width),
        along(dy, cy, this.plot.height)));
    };
    const sign = reach(1) >= reach(-1) ? 1 : -1;
    return [cx + sign * reach(sign) * Math.cos(angle), cy + sign * reach(sign) * Math.sin(angle)];
  }

  select(i) {
    this.selected = i;
    this.draw();
    this.plot.svg.querySelector(`[data-gaussian="${i}"]`)?.focus();
  }

  /** @param {?Object<string, number>} values by channel, that are under the mouse on the picture */
  markSeen(values) {
    this.seen = values;
    this.plot.svg.querySelectorAll('.seen').forEach((mark) => mark.remove());
    this.plot.svg.append(...this.seenMarks());
  }

  seenMarks() {
    if (!this.seen || !this.shown?.every((name) => name in this.seen)) return [];
    const [x, y] = this.toPlot(this.shown.map((name) => this.seen[name]));
    return [makeSvg('path', {class: 'seen', d: `M${x - 7} ${y}h14M${x} ${y - 7}v14`})];
  }

  drawDetails() {
    if (gestureIsActive()) return;
    const i = this.selected, gaussian = this.function.gaussians[i];
    const rows = [];
    if (gaussian) {
      const set = (key) => (value, gesture = newGesture()) => {
        this.change(i, {[key]: value}, gesture);
      };
      rows.push(make('div', {class: 'row'},
        labelled('Extinction', numberInput(gaussian.extinction, 'Peak of the extinction',
          set('extinction'), {min: 0})),
        colorInput(gaussian.color, 'Color of the Gaussian', set('color')),
        button('Remove', () => this.remove(i),
          {disabled: this.function.gaussians.length < 2 && !this.function.tables})));
      gaussian.channels.forEach((name, k) => rows.push(this.numbersOf(gaussian, i, name, k)));
    }
    const list = make('div', {class: 'row'}, ...this.function.gaussians.map((one, k) => {
      const chip = button(String(k + 1), () => this.select(k), {
        'aria-pressed': String(k === i), 'aria-label': `Select Gaussian ${k + 1}`});
      chip.style.borderBottom = `4px solid ${cssColor(one.color)}`;
      return chip;
    }));
    replaceKeepingFocus(this.details, list, ...rows, make('p', {class: 'hint'},
      'Double-click where the data are to add a Gaussian.'));
  }

  /** Center and half width along one channel. */
  numbersOf(gaussian, i, name, k) {
    const reach = reachOf(gaussian.matrix, k);
    return make('div', {class: 'row'}, make('span', {class: 'key'}, name),
      labelled('at', numberInput(gaussian.center[k], `Center in ${name}`, (value) => {
        const center = [...gaussian.center];
        center[k] = value;
        this.change(i, {center}, newGesture());
      })),
      labelled('±', numberInput(reach ?? 0, `Width in ${name}`, (value) => {
        if (value > 0) this.change(i, {matrix: withReach(gaussian.matrix, k, value)}, newGesture());
      }, {min: 0, disabled: reach === null})));
  }

  send(gesture) {
    this.draw();
    this.edit(this.function, gesture);
  }

  change(i, parts, gesture) {
    Object.assign(this.function.gaussians[i], parts);
    this.send(gesture);
  }

  remove(i) {
    if (this.function.gaussians.length < 2 && !this.function.tables) return;
    this.function.gaussians.splice(i, 1);
    this.selected = Math.max(0, i - 1);
    this.send(newGesture());
  }

  add(event) {
    if (event.target.closest('.grip') || event.target.closest('.ellipse')) return;
    const {x, y} = this.plot.positionOf(event);
    const near = this.function.gaussians[this.selected];
    const channels = this.shown[0] === this.shown[1] ? [this.shown[0]] : [...this.shown];
    const units = this.units();
    const radius = 22;
    const matrix = channels.map((_, k) => channels.map((__, j) =>
      j === k ? 1 / (radius * Math.abs(units[k])) : 0));
    this.function.gaussians.push({channels, center: this.fromPlot(x, y).slice(0, channels.length),
      matrix, extinction: near?.extinction ?? 1, color: '#ffd479'});
    this.selected = this.function.gaussians.length - 1;
    this.send(newGesture());
  }

  /** Calls `move` with where the pointer is, until the drag ends. */
  drag(event, i, move) {
    event.stopPropagation();
    event.preventDefault();
    if (event.button !== 0) return;
    this.selected = i;
    this.dragging = true;
    const gesture = newGesture();
    // The shapes are drawn anew while they move, so that the plot follows the drag.
    followDrag({currentTarget: this.plot.svg, pointerId: event.pointerId}, (next) => {
      move(this.plot.positionOf(next), gesture);
    }, () => {
      this.dragging = false;
      this.plot.svg.querySelector(`[data-gaussian="${i}"]`)?.focus();
    });
    this.draw();
  }

  pressBody(event, i, columns) {
    if (event.button === 2) return this.remove(i);
    const start = this.plot.positionOf(event);
    const from = [...this.function.gaussians[i].center];
    const units = this.units();
    this.drag(event, i, ({x, y}, gesture) => {
      const center = [...from];
      center[columns[0]] += (x - start.x) * units[0];
      center[columns[1]] += (y - start.y) * units[1];
      this.change(i, {center}, gesture);
    });
  }

  pressStretch(event, i, columns, k) {
    const gaussian = structuredClone(this.function.gaussians[i]);
    const units = this.units();
    const along = ellipseOf(planeMatrix(gaussian.matrix, columns, units)).angle + k * Math.PI / 2;
    const [cx, cy] = this.toPlot(columns.map((column) => gaussian.center[column]));
    const reach = ({x, y}) =>
      Math.max(2, Math.abs((x - cx) * Math.cos(along) + (y - cy) * Math.sin(along)));
    const start = reach(this.plot.positionOf(event));
    this.drag(event, i, (at, gesture) => {
      const factor = reach(at) / start;
      this.change(i, {matrix: mappedMatrix(gaussian.matrix, columns, units,
        stretching(along, factor))}, gesture);
    });
  }

  pressTurn(event, i, columns) {
    const gaussian = structuredClone(this.function.gaussians[i]);
    const units = this.units();
    const [cx, cy] = this.toPlot(columns.map((column) => gaussian.center[column]));
    const start = this.plot.positionOf(event);
    const first = Math.atan2(start.y - cy, start.x - cx);
    this.drag(event, i, ({x, y}, gesture) => {
      const turned = Math.atan2(y - cy, x - cx) - first;
      this.change(i, {matrix: mappedMatrix(gaussian.matrix, columns, units, turning(turned))},
        gesture);
    });
  }

  pressKey(event, i, columns) {
    const step = event.shiftKey ? 1 : 5;
    const moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step],
      ArrowDown: [0, step]};
    if (event.key === 'Delete' || event.key === 'Backspace') {
      this.remove(i);
    } else if (event.key in moves) {
      const units = this.units();
      const center = [...this.function.gaussians[i].center];
      columns.forEach((column, k) => { center[column] += moves[event.key][k] * units[k]; });
      this.change(i, {center}, newGesture());
    } else {
      return;
    }
    event.preventDefault();
    this.plot.svg.querySelector(`[data-gaussian="${this.selected}"]`)?.focus();
  }
}
