// SPDX-License-Identifier: Apache-2.0
import {CurveEditor} from './curve_editor.js';
import {GaussianEditor} from './gaussian_editor.js';
import {PresetGallery} from './presets.js';
import {button, choice, colorInput, gestureIsActive, labelled, make, newGesture, numberInput,
  replaceKeepingFocus, shortNumber} from './elements.js';

/** The transfer function of the selected layer, with what it can be replaced by. */
export class FunctionPanel {
  /** @param {import('./main.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.content = document.querySelector('#function-panel .content');
    this.histograms = new Map();
    this.presets = new PresetGallery(viewer, (name) => this.presetFunction(name),
      (name) => this.usePreset(name));
    const edit = (value, gesture) => viewer.editLayer('transfer_function', value, gesture);
    this.curve = new CurveEditor(edit, (i, value, gesture) => {
      const surfaces = structuredClone(viewer.layer().isosurfaces);
      surfaces[i].value = value;
      viewer.editLayer('isosurfaces', surfaces, gesture);
    }, (span) => this.askAnew([viewer.facts().channels[0]], span));
    this.gaussians = new GaussianEditor(edit, (channels) => this.ask(channels),
      (channels, span) => this.askAnew(channels, span));
    viewer.connection.on('histogram', (histogram) => {
      this.histograms.set(this.keyOf(histogram.layer, histogram.channels), histogram);
      this.update();
    });
    this.file = make('input', {type: 'file', hidden: true,
      accept: '.json,.xml,.csv,.vp,.txt,.xmlcolor', onchange: () => this.importFile()});
    this.asked = new Set();
  }

  keyOf(layer, channels) {
    return JSON.stringify([layer, channels]);
  }
  ask(channels) {
    const key = this.keyOf(this.viewer.selected, channels);
    if (this.asked.has(key)) return;
    this.asked.add(key);
    this.viewer.connection.send({type: 'histogram', layer: this.viewer.selected, channels});
  }
  /** Asks for counts over another span: {} is the middle of the values, {all}, {ranges}. */
  askAnew(channels, span) {
    this.asked.add(this.keyOf(this.viewer.selected, channels));
    this.viewer.connection.sendSoon('histogram',
      {type: 'histogram', layer: this.viewer.selected, channels, ...span});
  }
  /** The span that holds all but 0.1 % of the values at each end, or all of them. */
  middleRange() {
    const facts = this.viewer.facts();
    const histogram = this.histogram([facts.channels[0]]);
    const [lower, upper] = histogram
      ? [histogram.axes[0].lower, histogram.axes[0].upper] : facts.range;
    return lower < upper ? [lower, upper] : [lower, lower + 1];
  }
  histogram(channels) {
    return this.histograms.get(this.keyOf(this.viewer.selected, channels)) ?? null;
  }
  /** The data are others now. */
  forget() {
    this.histograms.clear();
    this.asked.clear();
  }

  update() {
    if (this.curve.dragging || this.gaussians.dragging || gestureIsActive()) return;
    const {viewer} = this;
    const layer = viewer.layer(), facts = viewer.facts();
    const transferFunction = layer.transfer_function;
    const parts = [];
    if (layer.labels) {
      parts.push(this.labelColors(layer));
    } else if (transferFunction?.points) {
      const channels = [facts.channels[0]];
      if (!this.histogram(channels)) this.ask(channels);
      this.curve.show(transferFunction, this.histogram(channels), layer.isosurfaces ?? []);
      parts.push(this.curve.element);
    } else if (transferFunction) {
      this.gaussians.show(transferFunction, facts.channels, (names) => this.histogram(names));
      parts.push(this.gaussians.element);
      if (transferFunction.tables) {
        parts.push(make('p', {class: 'hint'}, `The function also has ` +
          `${transferFunction.tables.length} tables of single channels, which stay as they are.`));
      }
      if (transferFunction.factor) {
        parts.push(make('p', {class: 'hint'},
          'Its extinctions have a factor by a channel, which stays as it is.'));
      }
    } else {
      parts.push(make('p', {class: 'empty'},
        'Only surfaces are shown. Make a function from the data to show the volume.'));
    }
    if (!layer.labels) parts.push(this.replacements(layer, facts), this.exchange(transferFunction));
    replaceKeepingFocus(this.content, ...parts);
  }

  replacements(layer, facts) {
    const {viewer} = this;
    const row = make('div', {class: 'row'});
    const suggest = (kind) => () => viewer.connection.send(
      {type: 'suggest', layer: viewer.selected, kind});
    const isField = Boolean(layer.field), isMesh = Boolean(layer.mesh);
    const isOfOneVariable = isField || (isMesh && facts.channels.length === 1);
    if (isOfOneVariable) row.append(button('Curve from the data', suggest('curve')));
    if (!isMesh) {
      row.append(button(isField ? 'Gaussians of value and gradient' : 'Gaussians from the data',
        suggest('gaussians')));
    }
    return isOfOneVariable ? make('div', {class: 'list'}, this.presets.element, row) : row;
  }

  preset(name) {
    return this.viewer.presets.find((preset) => preset.name === name);
  }

  /** Scans are also kept as numbers from 0 to 1, in which a preset of CT shows nothing. */
  presetFunction(name) {
    const [lower, upper] = this.viewer.facts().range;
    const isStretched = this.preset(name).hounsfield && upper > lower && upper - lower < 100;
    return isStretched ? {preset: name, range: [lower, upper]} : {preset: name};
  }

  usePreset(name) {
    const {viewer} = this;
    const {lit} = this.preset(name);
    const [lower, upper] = viewer.facts().range;
    const gesture = newGesture();
    const value = this.presetFunction(name);
    viewer.editLayer('transfer_function', value, gesture);
    // As on the command line, what is made for light gets some.
    if (lit && !viewer.layer().shading) viewer.editLayer('shading', {}, gesture);
    if (value.range) {
      viewer.showMessage(`${name} is in Hounsfield units, and the data go from ` +
        `${shortNumber(lower)} to ${shortNumber(upper)}: its points were moved to that range.`);
    }
  }

  exchange(transferFunction) {
    const {viewer} = this;
    const row = make('div', {class: 'row'}, this.file,
      button('Import…', () => this.file.click(),
        {title: 'A function of Pellucid, ParaView, 3D Slicer, VisIt, vtk.js or ANARI, or CSV'}));
    if (transferFunction) {
      const formats = [['', 'Export…'], ['pellucid', 'Pellucid']];
      if (transferFunction.points) {
        formats.push(['slicer', '3D Slicer'], ['paraview', 'ParaView'], ['table', 'CSV']);
      }
      row.append(choice('', formats, 'Export the function', (format) => {
        if (format) viewer.connection.send({type: 'export', layer: viewer.selected, format});
        this.update();
      }));
    }
    return row;
  }

  async importFile() {
    const [file] = this.file.files;
    if (!file) return;
    this.viewer.connection.send({type: 'import', layer: this.viewer.selected, name: file.name,
      text: await file.text()});
    this.file.value = '';
  }

  labelColors(layer) {
    const colors = layer.labels.colors ?? [];
    const set = (i, parts, gesture = newGesture()) => {
      const next = structuredClone(colors);
      Object.assign(next[i], parts);
      this.viewer.editLayer('colors', next, gesture);
    };
    const rows = colors.slice(0, 200).map((style, i) => make('div', {class: 'row'},
      colorInput(style.color, `Color of label ${style.label}`,
        (color, gesture) => set(i, {color}, gesture)),
      labelled('Extinction', numberInput(style.extinction, `Extinction of label ${style.label}`,
        (extinction) => set(i, {extinction}), {min: 0})),
      make('span', {}, `${style.label} ${style.name ?? ''}`)));
    if (colors.length > 200) rows.push(make('p', {class: 'hint'}, 'The first 200 labels are shown.'));
    return make('div', {class: 'list'}, ...rows);
  }

  /** @param {?Object} probe a message "probe" */
  markSeen(probe) {
    const values = {};
    for (const {layer, channel, value} of probe?.values ?? []) {
      if (layer === this.viewer.selected) values[channel] = value;
    }
    this.curve.markSeen(values[this.viewer.facts().channels[0]] ?? null);
    this.gaussians.markSeen(values);
  }
}
