// SPDX-License-Identifier: Apache-2.0
import {make, makeSvg, shortNumber, themeColor} from './elements.js';

/** A canvas with counts, and an SVG over it in which things are dragged. */
export class Plot {
  /** @param {number} height of the area of the data; the numbers of the axis stand below it */
  constructor(height, name) {
    this.height = height;
    this.below = 18;
    this.canvas = make('canvas', {'aria-hidden': 'true'});
    this.svg = makeSvg('svg', {role: 'group', 'aria-label': name});
    this.element = make('div', {class: 'plot'}, this.canvas, this.svg);
    this.width = 346;
    /** Whether counts, and the values of one variable, stand on logarithmic scales. */
    this.hasLogCounts = true;
    this.hasLogValues = false;
    /** @type {{lower: number, upper: number}[]} along x, and for two variables along y */
    this.axes = [{lower: 0, upper: 1}, {lower: 0, upper: 1}];
    this.setSize();
  }

  setSize() {
    this.canvas.width = this.width * 2;
    this.canvas.height = (this.height + this.below) * 2;
    this.canvas.style.height = `${this.height + this.below}px`;
    this.svg.setAttribute('viewBox', `0 0 ${this.width} ${this.height + this.below}`);
    this.svg.setAttribute('preserveAspectRatio', 'none');
  }

  /** Clears the canvas; one unit of its context is one of the SVG. */
  begin() {
    const width = this.element.clientWidth || this.width;
    if (width !== this.width) {
      this.width = width;
      this.setSize();
    }
    const context = this.canvas.getContext('2d');
    context.setTransform(2, 0, 0, 2, 0, 0);
    context.clearRect(0, 0, this.width, this.height + this.below);
    return context;
  }

  /** Where a value stands on the axis: 0 at its lower end, 1 at its upper one. */
  share(value) {
    const {lower, upper} = this.axes[0];
    if (!this.isLogarithmic()) return (value - lower) / (upper - lower);
    const least = this.leastPositive();
    return Math.log(Math.max(value, least) / least) / Math.log(upper / least);
  }
  x(value) { return this.share(value) * this.width; }
  valueAt(x) {
    const {lower, upper} = this.axes[0];
    const share = x / this.width;
    if (!this.isLogarithmic()) return lower + share * (upper - lower);
    const least = this.leastPositive();
    return least * (upper / least) ** share;
  }
  isLogarithmic() { return this.hasLogValues && this.axes[0].upper > 0; }
  /** The lower end of a logarithmic axis; what is less stands there. */
  leastPositive() {
    const {lower, upper} = this.axes[0];
    return lower > 0 ? lower : upper / 1e4;
  }
  /** Where a pointer is, in units of the SVG. */
  positionOf(event) {
    const box = this.svg.getBoundingClientRect();
    return {x: (event.clientX - box.left) / box.width * this.width,
      y: (event.clientY - box.top) / box.height * (this.height + this.below)};
  }

  heightOf(count) { return this.hasLogCounts ? Math.log1p(count) : count; }

  /** Counts of one variable as bars. */
  drawBars(context, histogram) {
    if (!histogram) return;
    const {lower, upper, bins} = histogram.axes[0];
    const largest = this.heightOf(histogram.count.reduce((a, b) => Math.max(a, b), 1));
    const edge = (i) => this.x(lower + (upper - lower) * i / bins);
    context.fillStyle = themeColor('--bars');
    histogram.count.forEach((count, i) => {
      const height = this.heightOf(count) / largest * (this.height - 14);
      context.fillRect(edge(i), this.height - height, edge(i + 1) - edge(i) + 0.4, height);
    });
  }

  /** Counts of two variables as shades. */
  drawShades(context, histogram) {
    const [columns, rows] = histogram.axes.map((axis) => axis.bins);
    const largest = this.heightOf(histogram.count.reduce((a, b) => Math.max(a, b), 1));
    const image = new ImageData(columns, rows);
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(themeColor('--text').slice(at, at + 2), 16));
    histogram.count.forEach((count, i) => {
      const row = rows - 1 - Math.floor(i / columns);
      const at = (row * columns + i % columns) * 4;
      image.data.set([r, g, b, count === 0 ? 0 : 30 + 190 * this.heightOf(count) / largest], at);
    });
    const picture = new OffscreenCanvas(columns, rows);
    picture.getContext('2d').putImageData(image, 0, 0);
    context.imageSmoothingEnabled = false;
    context.drawImage(picture, 0, 0, this.width, this.height);
  }

  /** Numbers at the ends of the x axis, and of the y axis if there is a second one. */
  axisTexts(names) {
    const [x, y] = this.axes;
    const baseline = this.height + this.below - 5;
    const texts = [
      makeSvg('text', {x: 3, y: baseline},
        shortNumber(this.isLogarithmic() ? this.leastPositive() : x.lower)),
      makeSvg('text', {x: this.width - 3, y: baseline, 'text-anchor': 'end'},
        shortNumber(x.upper)),
      makeSvg('text', {x: this.width / 2, y: baseline, 'text-anchor': 'middle'}, names[0]),
    ];
    if (names.length > 1) {
      texts.push(makeSvg('text', {x: 3, y: 13}, `${shortNumber(y.upper)} ${names[1]}`));
    }
    return texts;
  }
}
