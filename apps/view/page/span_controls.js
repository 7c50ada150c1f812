// SPDX-License-Identifier: Apache-2.0
import {button, labelled, labelledAfter, make, numberInput, replaceKeepingFocus}
  from './elements.js';

/**
 * Chooses which values a plot shows: from 0.1 to 99.9 % of them, all, or a span that is typed or
 * zoomed; and whether its scales are logarithmic.
 */
export class SpanControls {
  /**
   * @param {import('./plot.js').Plot} plot
   * @param {Object} settings
   * @param {function(Object): void} settings.ask called with the part of a message "histogram" that
   *   says the span
   * @param {function(): void} settings.draw called when a scale changes
   * @param {boolean} settings.canLogValues
   */
  constructor(plot, {ask, draw, canLogValues}) {
    this.plot = plot;
    this.ask = ask;
    this.draw = draw;
    this.canLogValues = canLogValues;
    this.element = make('div', {class: 'list'});
    plot.svg.addEventListener('wheel', (event) => {
      if (!event.ctrlKey) return;  // the wheel alone moves the panel
      event.preventDefault();
      const {x, y} = plot.positionOf(event);
      this.zoom(1.002 ** event.deltaY, [x / plot.width, 1 - y / plot.height]);
    }, {passive: false});
  }

  /** @param {{lower: number, upper: number}[]} axes as they are shown @param {string[]} names */
  show(axes, names) {
    this.axes = axes;
    const rounded = (value, {lower, upper}) =>
      (Math.abs(value) < 1e-6 * (upper - lower) ? 0 : value);
    const end = (k, which) => numberInput(rounded(axes[k][which], axes[k]),
      `${which === 'lower' ? 'Least' : 'Largest'} value of ${names[k]} in the plot`, (value) => {
        const ranges = axes.map(({lower, upper}) => [lower, upper]);
        ranges[k][which === 'lower' ? 0 : 1] = value;
        if (ranges[k][0] < ranges[k][1]) this.ask({ranges});
      });
    const check = (key, text) => {
      const input = make('input', {type: 'checkbox', checked: this.plot[key], onchange: () => {
        this.plot[key] = input.checked;
        this.draw();
      }});
      return labelledAfter(input, text);
    };
    const middle = axes.map(() => 0.5);
    replaceKeepingFocus(this.element,
      make('div', {class: 'row'},
        button('Middle', () => this.ask({}), {title: 'From 0.1 to 99.9 % of the values'}),
        button('All', () => this.ask({all: true}), {title: 'From the least to the largest value'}),
        button('+', () => this.zoom(0.5, middle), {'aria-label': 'Zoom into the plot',
          title: 'Ctrl and the wheel zoom, too'}),
        button('−', () => this.zoom(2, middle), {'aria-label': 'Zoom out of the plot'}),
        check('hasLogCounts', 'log counts'),
        this.canLogValues ? check('hasLogValues', 'log values') : ''),
      ...axes.map((_, k) => make('div', {class: 'row'},
        labelled(axes.length > 1 ? `${names[k]} from` : 'From', end(k, 'lower')),
        labelled('to', end(k, 'upper')))));
  }

  /** Shows `factor` times as much, around a share of each axis. */
  zoom(factor, around) {
    if (!this.axes) return;
    const ranges = this.axes.map(({lower, upper}, k) => {
      const at = lower + around[k] * (upper - lower);
      return [at + factor * (lower - at), at + factor * (upper - at)];
    });
    if (!ranges.every(([lower, upper]) => lower < upper)) return;
    this.axes = ranges.map(([lower, upper]) => ({lower, upper}));
    this.ask({ranges});
  }
}
