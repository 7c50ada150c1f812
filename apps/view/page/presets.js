// SPDX-License-Identifier: Apache-2.0
import {button, make} from './elements.js';

/** Presets with small pictures of the data, which are asked for one by one when they are seen. */
export class PresetGallery {
  /**
   * @param {import('./main.js').Viewer} viewer
   * @param {function(string): Object} functionOf the function of a preset's name
   * @param {function(string): void} use called with a name
   */
  constructor(viewer, functionOf, use) {
    this.viewer = viewer;
    this.functionOf = functionOf;
    this.use = use;
    this.grid = make('div', {class: 'presets'});
    this.element = make('details', {class: 'inner', ontoggle: () => this.begin()},
      make('summary', {}, 'Presets'), this.grid);
    /** @type {string[]} names whose pictures are to be asked for */
    this.wanted = [];
    this.asked = null;
    this.seen = new IntersectionObserver((entries) => {
      for (const {isIntersecting, target} of entries) {
        if (!isIntersecting) continue;
        this.seen.unobserve(target);
        this.wanted.push(target.dataset.preset);
      }
      this.askNext();
    });
    viewer.connection.on('thumbnail', (message) => this.show(message));
    viewer.connection.on('error', () => this.skip());
    viewer.connection.on('open', () => { this.asked = null; });
  }

  /** The pictures are of the camera at the time when the list was opened. */
  begin() {
    this.seen.disconnect();
    this.wanted = [];
    if (!this.element.open) return this.grid.replaceChildren();
    this.grid.replaceChildren(...this.viewer.presets.map(({name, description}) => {
      const one = button('', () => this.use(name), {title: description, 'data-preset': name});
      one.append(make('canvas', {width: 96, height: 72, 'aria-hidden': 'true'}),
        make('span', {}, name));
      return one;
    }));
    for (const one of this.grid.children) this.seen.observe(one);
  }

  askNext() {
    if (this.asked !== null || this.wanted.length === 0) return;
    this.asked = this.wanted.shift();
    this.viewer.connection.send({type: 'thumbnail', layer: this.viewer.selected,
      function: this.functionOf(this.asked)});
  }

  skip() {
    if (this.asked === null) return;
    this.asked = null;
    this.askNext();
  }

  show({function: {preset}, width, height, bytes}) {
    const canvas = this.grid.querySelector(`[data-preset="${preset}"] canvas`);
    canvas?.getContext('2d').putImageData(new ImageData(bytes, width, height), 0, 0);
    canvas?.classList.add('made');
    this.skip();
  }
}
