// SPDX-License-Identifier: Apache-2.0
import {button, make} from './elements.js';

/** Milliseconds: a fit that ends sooner is not told. */
const patience = 300;

/** Tells how far a fit of Gaussians is, with a button that ends it. */
export class FitProgress {
  /** @param {import('./connection.js').Connection} connection @param {Element} stage */
  constructor(connection, stage) {
    this.bar = make('progress', {max: 1, 'aria-label': 'Part of the fit that is done'});
    this.element = make('div', {id: 'fit', role: 'status', hidden: true},
      'Fitting Gaussians to the data…', this.bar,
      button('Cancel', () => connection.send({type: 'cancel'}),
        {title: 'Keep the function as it is'}));
    stage.append(this.element);
    connection.on('progress', ({fraction}) => this.show(fraction));
    connection.on('lost', () => this.show(1));
  }

  show(fraction) {
    this.bar.value = fraction;
    if (fraction < 1) {
      this.timer ??= setTimeout(() => { this.element.hidden = false; }, patience);
    } else {
      clearTimeout(this.timer);
      this.timer = undefined;
      this.element.hidden = true;
    }
  }
}
