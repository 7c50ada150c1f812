// SPDX-License-Identifier: Apache-2.0
import {button, make, makeSvg, shortNumber} from './elements.js';
import {angle, distance} from './slice_geometry.js';

const pointsOf = {distance: 2, angle: 3};
const titles = {distance: 'Distance', angle: 'Angle'};

/** Distances and angles between positions in the world. */
export class Measures {
  /** @param {import('./four_views.js').FourViews} views */
  constructor(views) {
    this.views = views;
    /** @type {{kind: string, number: number, points: number[][]}[]} */
    this.list = [];
    /** The measure whose points are being chosen. */
    this.begun = null;
    this.counts = {distance: 0, angle: 0};
  }

  isOn() { return this.views.tool in pointsOf; }
  isBegun() { return this.begun !== null; }

  /** Adds a point. @returns {Object} the measure that it belongs to */
  add(point) {
    const kind = this.views.tool;
    this.begun ??= {kind, number: this.counts[kind] + 1, points: []};
    const measure = this.begun;
    measure.points.push(point);
    this.end = null;
    if (measure.points.length === pointsOf[kind]) {
      this.list.push(measure);
      ++this.counts[kind];
      this.begun = null;
    }
    this.views.measuresChanged();
    return measure;
  }
  /** Shows where the next point would be. */
  hover(point) {
    this.end = point;
    this.views.drawMarks();
  }
  /** Forgets a point that was the begin of something else. */
  forgetLast(measure) {
    if (!measure) return;
    this.list = this.list.filter((one) => one !== measure);
    if (this.begun === measure) this.cancel();
    this.views.measuresChanged();
  }
  cancel() {
    this.begun = this.end = null;
    this.views.measuresChanged();
  }
  clear() {
    this.list = [];
    this.begun = this.end = null;
    this.counts = {distance: 0, angle: 0};
  }

  nameOf({kind, number}) { return `${titles[kind]} ${number}`; }
  /** The number of a measure with its unit; empty while points are missing. */
  textOf({kind, points}) {
    if (points.length < pointsOf[kind]) return '';
    if (kind === 'angle') return `${shortNumber(angle(points))}°`;
    const {unit} = this.views;
    return `${shortNumber(distance(...points))}${unit ? ' ' + unit : ''}`;
  }

  /**
   * Shapes of all measures.
   * @param {function(number[]): ?{x: number, y: number, isNear: boolean}} place of a point; null:
   * it is not seen. What is near is drawn; the rest of it is dashed.
   */
  shapes(place) {
    const drawn = [...this.list];
    if (this.begun) {
      drawn.push({...this.begun, points: [...this.begun.points, ...(this.end ? [this.end] : [])]});
    }
    return drawn.flatMap((measure) => {
      const at = measure.points.map(place);
      if (!at.every(Boolean) || !at.some(({isNear}) => isNear)) return [];
      const isFar = !at.every(({isNear}) => isNear);
      const lines = at.slice(1).map(({x, y}, i) => ({x1: at[i].x, y1: at[i].y, x2: x, y2: y}));
      const last = at[at.length - 1];
      return [...lines.flatMap((line) => [makeSvg('line', {class: 'halo', ...line}),
        makeSvg('line', {class: isFar ? 'measure far' : 'measure', ...line})]),
      ...at.filter(({isNear}) => isNear).map(({x, y}) =>
        makeSvg('circle', {class: 'measure', cx: x, cy: y, r: 3.5})),
      makeSvg('text', {x: last.x + 8, y: last.y - 6, 'text-anchor': 'start'},
        this.textOf(measure))];
    });
  }

  /** The list, for a panel. */
  parts() {
    const {views} = this;
    const rows = this.list.map((measure) => make('div', {class: 'row measure'},
      make('span', {}, `${this.nameOf(measure)}: ${this.textOf(measure)}`),
      button('Go to', () => views.setCrosshair(measure.points[0]),
        {'aria-label': `Go to ${this.nameOf(measure)}`}),
      button('Remove', () => {
        this.list = this.list.filter((one) => one !== measure);
        views.measuresChanged();
      }, {'aria-label': `Remove ${this.nameOf(measure)}`})));
    if (rows.length === 0) {
      rows.push(make('p', {class: 'hint'},
        'Distance: two clicks in slices. Angle: three, the second one at its corner.'));
    }
    return rows;
  }
}
