// SPDX-License-Identifier: Apache-2.0
import {button, choice, gestureIsActive, labelled, labelledAfter, make, makeSvg, numberInput,
  replaceKeepingFocus, shortNumber, slider} from './elements.js';
import {Measures} from './measures.js';
import {axisColors} from './overlay.js';
import {projected, sliceName, stepped} from './slice_geometry.js';
import {SliceView, withUnit} from './slice_view.js';

const axisNames = ['x', 'y', 'z'];
/** Levels and windows in Hounsfield units, of data that have such numbers. */
const ctWindows = {'brain': [40, 80], 'soft tissue': [50, 400], 'lung': [-600, 1500],
  'bone': [500, 2000]};
const hasHounsfieldUnits = ([least, most]) => least <= -500 && most >= 500 && most < 32768;
/** Where the layout is kept. */
const key = 'pellucid.views';
const isNarrow = () => matchMedia('(max-width: 820px)').matches;

/** Three slices and the volume, linked by a crosshair. */
export class FourViews {
  /** @param {import('./main.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.panes = document.getElementById('panes');
    this.bar = document.getElementById('slice-bar');
    this.panel = document.getElementById('slices-panel');
    this.content = this.panel.querySelector('.content');
    /** Position in the world; null: there is no scene. @type {?number[]} */
    this.crosshair = null;
    /** The layer and the channel that slices show; null: there are only labels. */
    this.channel = null;
    this.tool = 'crosshair';
    this.labelShare = 0.4;
    this.hasLines = true;
    /** Lower and upper end of the grey window of each channel. @type {Map<string, number[]>} */
    this.windows = new Map();
    this.asked = new Set();
    this.measures = new Measures(this);
    this.slices = [0, 1, 2].map((axis) => new SliceView(this, axis));
    const stage = document.getElementById('stage');
    // The order of the focus is that of the views: rows from the upper left.
    stage.before(this.slices[2].element);
    stage.after(this.slices[1].element, this.slices[0].element);
    this.makeBar();
    this.addMessages();
    this.addKeys();
    const kept = this.keptLayout();
    this.show(kept.layout, kept.shown);
  }

  get anatomical() { return this.viewer.anatomical; }
  get overlay() { return this.viewer.picture.frame?.overlay; }
  get unit() { return this.overlay?.unit ?? ''; }
  numberText(number) { return withUnit(number, this.unit); }
  isOn() { return this.layout === 'four'; }

  // --- The layout.

  keptLayout() {
    try {
      const {layout, shown} = JSON.parse(localStorage.getItem(key));
      if (['four', 'volume'].includes(layout)) return {layout, shown};
    } catch {
      // Nothing is kept, or this page may keep nothing.
    }
    return {layout: 'volume'};
  }

  /**
   * @param {string} layout 'four' or 'volume'
   * @param {string} shown of four views: 'all', 'volume', or the axis that a slice crosses
   */
  show(layout, shown = isNarrow() ? '2' : 'all') {
    this.layout = layout;
    this.shown = ['all', 'volume', '0', '1', '2'].includes(shown) ? shown : 'all';
    const isOn = this.isOn();
    this.panes.dataset.shown = isOn ? this.shown : 'volume';
    document.body.dataset.layout = layout;
    this.bar.hidden = this.panel.hidden = !isOn;
    document.getElementById('four').setAttribute('aria-pressed', String(isOn));
    for (const one of this.viewButtons) {
      one.setAttribute('aria-pressed', String(one.dataset.view === this.shown));
    }
    try {
      localStorage.setItem(key, JSON.stringify({layout, shown: this.shown}));
    } catch {
      // As above.
    }
    this.changed();
  }
  toggle() {
    this.show(this.isOn() ? 'volume' : 'four', this.shown);
    if (this.isOn()) this.update();
  }

  /** Shows a slice alone, or all views again. */
  enlarge(axis) {
    this.show('four', this.shown === 'all' ? String(axis) : 'all');
  }

  makeBar() {
    this.viewButtons = [['all', 'All views'], ['2', ''], ['1', ''], ['0', ''], ['volume', 'Volume']]
      .map(([view, text]) => button(text, () => this.show('four', view), {'data-view': view}));
    this.toolButtons = [['crosshair', 'Crosshair', 'x'], ['window', 'Window', 'w'],
      ['distance', 'Distance', 'd'], ['angle', 'Angle', 'a']].map(([tool, text, letter]) =>
      button(text, () => this.take(tool), {'data-tool': tool, title: `${text} (${letter})`}));
    this.readout = make('output', {id: 'readout', 'aria-live': 'polite'});
    this.bar.append(
      make('div', {class: 'row', role: 'group', 'aria-label': 'Views'}, ...this.viewButtons),
      make('div', {class: 'row', role: 'group', 'aria-label': 'What a drag does'},
        ...this.toolButtons, button('Fit', () => this.fit(), {title: 'Show all in the slices'})),
      this.readout);
    document.getElementById('four').addEventListener('click', () => this.toggle());
    this.take('crosshair');
  }

  /** What a click and a drag in a slice do. */
  take(tool) {
    this.tool = tool;
    for (const one of this.toolButtons) {
      one.setAttribute('aria-pressed', String(one.dataset.tool === tool));
    }
    this.panes.dataset.tool = tool;
    if (this.measures.isBegun()) this.measures.cancel();
  }

  addKeys() {
    const tools = {x: 'crosshair', w: 'window', d: 'distance', a: 'angle'};
    addEventListener('keydown', (event) => {
      if (event.target.closest('input, select, textarea')) return;
      if (event.ctrlKey || event.metaKey || event.altKey || !this.viewer.scene) return;
      if (event.key === 'f') this.toggle();
      else if (this.isOn() && tools[event.key]) this.take(tools[event.key]);
      else if (event.key === 'Escape' && this.measures.isBegun()) this.measures.cancel();
    });
  }

  fit() {
    for (const slice of this.slices) slice.fit();
  }

  // --- The data.

  addMessages() {
    const {connection, picture} = this.viewer;
    connection.on('slice', (message) => this.slices[message.axis].receive(message));
    connection.on('located', (message) => this.tell(message));
    connection.on('histogram', (histogram) => this.takeHistogram(histogram));
    connection.on('probe', ({picks, position}) => {
      if (picks && position) this.setCrosshair(position);
    });
    const askAnew = () => { for (const slice of this.slices) slice.askAnew(); };
    connection.on('open', askAnew);
    // One that is about a slice would come again and again.
    connection.on('error', () => { for (const slice of this.slices) slice.isAsked = false; });
    connection.on('frame', () => this.drawMarks());
    picture.marks = (width, height) => this.volumeMarks(width, height);
    picture.onclick = ({x, y}) => {
      if (this.isOn()) connection.send({type: 'probe', x, y, picks: true});
    };
  }

  /** Another file is shown. */
  forget() {
    this.crosshair = this.channel = this.dataKey = null;
    this.windows.clear();
    this.asked.clear();
    this.measures.clear();
    this.readout.value = '';
    for (const slice of this.slices) slice.slice = slice.shown = null;
  }

  /** The scene is another one, or another layer is selected. */
  update() {
    const {viewer} = this;
    if (!viewer.scene) return;
    const {lower, upper} = viewer.box;
    this.chooseChannel();
    this.crosshair ??= lower.map((low, a) => this.stepped(a, (low + upper[a]) / 2, 0));
    for (const one of this.viewButtons) {
      if (/\d/.test(one.dataset.view)) {
        one.textContent = sliceName(Number(one.dataset.view), this.anatomical);
      }
    }
    // Looks of volumes change no slice.
    const data = viewer.scene.layers.map(({transfer_function: _0, isosurfaces: _1, slices: _2,
      shading: _3, gradient_opacity: _4, clip: _5, projection: _6, ...rest}) => rest);
    const dataKey = JSON.stringify([data, viewer.box, this.channel, viewer.timeline.time]);
    const isNew = dataKey !== this.dataKey;
    this.dataKey = dataKey;
    if (isNew) this.changed();
    this.updatePanel();
  }

  /** Slices show the selected layer, or the first one that has values. */
  chooseChannel() {
    const {viewer} = this;
    const count = (i) => (viewer.facts(i)?.kind === 'labels' ? 0 : viewer.facts(i)?.ranges.length);
    if (this.selected !== viewer.selected && count(viewer.selected) > 0) {
      this.channel = {layer: viewer.selected, channel: 0};
    }
    this.selected = viewer.selected;
    const {layer, channel} = this.channel ?? {};
    if (layer !== undefined && channel < count(layer)) return;
    const first = viewer.scene.layers.findIndex((_, i) => count(i) > 0);
    this.channel = first >= 0 ? {layer: first, channel: 0} : null;
  }

  channelKey({layer, channel}) { return `${layer} ${channel}`; }

  /** The grey window of a channel: the middle of its values unless the user chose another. */
  windowOf(channel = this.channel) {
    const kept = this.windows.get(this.channelKey(channel));
    if (kept) return kept;
    const [least, most] = this.viewer.facts(channel.layer)?.ranges[channel.channel] ?? [0, 1];
    return least < most ? [least, most] : [least - 0.5, least + 0.5];
  }
  setWindow(lower, upper) {
    if (!this.channel || !(upper > lower)) return;
    this.windows.set(this.channelKey(this.channel), [lower, upper]);
    this.repaint();
    this.updatePanel();
  }
  /** Moves level and window with a drag, in parts of the view. */
  dragWindow(x, y) {
    if (!this.channel) return;
    const [lower, upper] = this.windowOf();
    const [least, most] = this.viewer.facts(this.channel.layer).ranges[this.channel.channel];
    const extent = (most - least) || 1;
    const level = (lower + upper) / 2 + y * extent;
    const width = Math.max(upper - lower + x * extent, extent / 1000);
    this.setWindow(level - width / 2, level + width / 2);
  }
  /** Asks for the middle of the values, once for each channel. */
  askWindow() {
    if (!this.channel || !this.isOn()) return;
    const wanted = this.channelKey(this.channel);
    if (this.windows.has(wanted) || this.asked.has(wanted)) return;
    this.asked.add(wanted);
    const {layer, channel} = this.channel;
    this.viewer.connection.send({type: 'histogram', layer,
      channels: [this.viewer.facts(layer).channels[channel]]});
  }
  takeHistogram({layer, channels, axes}) {
    const channel = this.viewer.facts(layer)?.channels.indexOf(channels[0]);
    const wanted = this.channelKey({layer, channel});
    if (channels.length !== 1 || !this.asked.delete(wanted) || this.windows.has(wanted)) return;
    const {lower, upper} = axes[0];
    if (!(upper > lower)) return;
    this.windows.set(wanted, [lower, upper]);
    this.repaint();
    this.updatePanel();
  }

  // --- The crosshair.

  steps(axis) { return this.viewer.facts(this.channel?.layer ?? 0).steps[axis]; }
  stepped(axis, position, by) { return stepped(this.steps(axis), position, by); }
  /** Half of the distance between slices. */
  reach(axis) { return 0.5 * this.steps(axis).step * (1 + 1e-9); }

  setCrosshair(position) {
    if (!this.crosshair) return;
    const {lower, upper} = this.viewer.box;
    const before = this.crosshair;
    this.crosshair = position.map((at, a) => Math.min(upper[a], Math.max(lower[a], at)));
    this.slices.forEach((slice, axis) => {
      if (this.crosshair[axis] !== before[axis]) slice.ask();
    });
    this.crosshairMoved();
  }
  moveTo(axis, position) {
    this.setCrosshair(this.crosshair.map((at, a) => (a === axis ? position : at)));
  }
  step(axis, by) {
    this.moveTo(axis, this.stepped(axis, this.crosshair[axis], by));
  }

  crosshairMoved() {
    this.drawMarks();
    this.locate();
    this.content.querySelectorAll('[data-position]').forEach((input) => {
      if (input !== document.activeElement) {
        input.value = shortNumber(this.crosshair[input.dataset.position]);
      }
    });
  }
  locate() {
    if (!this.isOn() || !this.crosshair) return;
    this.viewer.connection.sendSoon('locate', {type: 'locate', position: this.crosshair});
  }

  /** @param {Object} located a message "located" */
  tell({position, values, labels, voxels}) {
    const {viewer} = this;
    if (!viewer.scene) return;
    const isOne = viewer.scene.layers.length === 1;
    const nameOf = (i) => (isOne ? '' : `${viewer.nameOf(i)} `);
    const layer = this.channel?.layer ?? 0;
    const voxel = voxels.find((one) => one.layer === layer) ?? voxels[0];
    const parts = [`(${position.map(shortNumber).join(', ')})${this.unit ? ' ' + this.unit : ''}`];
    if (values.length + labels.length === 0) parts.push('outside of the data');
    if (voxel) parts.push(`voxel ${voxel.index.join(', ')}`);
    parts.push(...values.map(({layer: i, channel, value}) =>
      `${nameOf(i)}${channel} ${shortNumber(value)}`));
    parts.push(...labels.map(({layer: i, label, name}) =>
      `${nameOf(i)}label ${label}${name ? ` ${name}` : ''}`));
    this.readout.value = parts.join(' · ');
    this.readout.title = this.readout.value;
  }

  // --- What is drawn.

  /** Slices of other data, or of another layout. */
  changed() {
    if (!this.crosshair || !this.isOn()) return;
    this.askWindow();
    for (const slice of this.slices) slice.moved();
    this.locate();
  }
  repaint() {
    for (const slice of this.slices) {
      slice.compose();
      slice.draw();
    }
  }
  drawMarks() {
    if (!this.isOn() || !this.crosshair) return;
    for (const slice of this.slices) slice.draw();
    this.viewer.picture.drawOverlay();
  }
  measuresChanged() {
    this.drawMarks();
    this.updatePanel();
  }

  /** The crosshair and the measures on the picture of the volume. */
  volumeMarks(width, height) {
    const matrix = this.overlay?.matrix;
    if (!this.isOn() || !this.crosshair || !matrix) return [];
    const place = (position) => {
      const at = projected(matrix, position);
      return at && {x: at.x * width, y: at.y * height, isNear: true};
    };
    const {lower, upper} = this.viewer.box;
    const lines = (this.hasLines ? [0, 1, 2] : []).flatMap((axis) => {
      const [from, to] = [lower, upper].map((end) =>
        place(this.crosshair.map((at, a) => (a === axis ? end[a] : at))));
      if (!from || !to) return [];
      const ends = {x1: from.x, y1: from.y, x2: to.x, y2: to.y};
      const line = makeSvg('line', {class: 'cross', ...ends});
      line.style.stroke = axisColors[axis];
      return [makeSvg('line', {class: 'halo', ...ends}), line];
    });
    const middle = place(this.crosshair);
    const marker = middle ? [makeSvg('circle', {class: 'crosshair', r: 5, cx: middle.x,
      cy: middle.y})] : [];
    return [...lines, ...marker, ...this.measures.shapes(place)];
  }

  updatePanel() {
    if (!this.isOn() || !this.crosshair || gestureIsActive()) return;
    replaceKeepingFocus(this.content, ...this.parts());
  }

  parts() {
    const parts = [this.positionRow()];
    if (this.channel) parts.unshift(...this.channelRows());
    if (this.viewer.scene.layers.some(({labels, mask}) => labels || mask)) {
      parts.push(labelled('Labels', slider(this.labelShare, 0, 1, 'Opacity of labels in slices',
        (share) => {
          this.labelShare = share;
          this.repaint();
        }), 'inline grow'));
    }
    parts.push(make('div', {class: 'list', role: 'group', 'aria-label': 'Measures'},
      ...this.measures.parts()));
    return parts;
  }

  channelRows() {
    const {viewer} = this;
    const options = viewer.scene.layers.flatMap((_, i) => {
      const {kind, ranges, channels} = viewer.facts(i);
      if (kind === 'labels') return [];
      return ranges.map((_range, c) => [this.channelKey({layer: i, channel: c}),
        ranges.length > 1 ? `${viewer.scene.layers.length > 1 ? viewer.nameOf(i) + ': ' : ''}` +
        channels[c] : viewer.nameOf(i)]);
    });
    const rows = [];
    if (options.length > 1) {
      rows.push(labelled('Slices show', choice(this.channelKey(this.channel), options,
        'Channel of the slices', (chosen) => {
          const [layer, channel] = chosen.split(' ').map(Number);
          this.channel = {layer, channel};
          this.update();
        })));
    }
    const [lower, upper] = this.windowOf();
    const level = (lower + upper) / 2, width = upper - lower;
    const range = viewer.facts(this.channel.layer).ranges[this.channel.channel];
    const set = (nextLevel, nextWidth) =>
      this.setWindow(nextLevel - nextWidth / 2, nextLevel + nextWidth / 2);
    rows.push(make('div', {class: 'row'},
      labelled('Level', numberInput(level, 'Level of the slices', (next) => set(next, width))),
      labelled('Window', numberInput(width, 'Window of the slices',
        (next) => set(level, next), {min: 0})),
      button('Auto', () => {
        this.windows.delete(this.channelKey(this.channel));
        this.askWindow();
      }, {title: 'The middle of the values', 'aria-label': 'Window of the middle of the values'}),
      ...(hasHounsfieldUnits(range) ? [choice('', [['', 'CT…'], ...Object.keys(ctWindows)
        .map((name) => [name, name])], 'Window of CT', (name) => {
        if (name) set(...ctWindows[name]);
      })] : [])));
    return rows;
  }

  positionRow() {
    return make('div', {class: 'row'}, 'Crosshair', ...axisNames.map((name, a) =>
      numberInput(this.crosshair[a], `${name} of the crosshair`,
        (next) => this.moveTo(a, next), {'data-position': a})), this.unit,
    labelledAfter(make('input', {type: 'checkbox', checked: this.hasLines, onchange: (event) => {
      this.hasLines = event.target.checked;
      this.drawMarks();
    }}), 'Lines'));
  }
}
