// SPDX-License-Identifier: Apache-2.0
import {Connection} from './connection.js';
import {embeddedNote} from './end.js';
import {FitProgress} from './fit_progress.js';
import {FourViews} from './four_views.js';
import {FunctionPanel} from './function_panel.js';
import {LostPanel} from './lost_panel.js';
import {OpenPanel} from './open_panel.js';
import {Picture} from './picture.js';
import {SavePanel} from './save_panel.js';
import {ClipPanel, LayersPanel, LightPanel, SurfacesPanel, probeText} from './scene_panels.js';
import {Timeline} from './timeline.js';
import {gestureIsActive, make, shortNumber} from './elements.js';

/** Largest error of a pixel at a position of the slider: ten steps to a power of ten. */
const toleranceAt = (step) => Math.min(1, 10 ** (-1 - step / 10));
const stepAt = (tolerance) => Math.round(-10 * (Math.log10(tolerance) + 1));

/** The page: what is shown, and who is told of it. */
export class Viewer {
  constructor() {
    this.connection = new Connection();
    this.picture = new Picture(this.connection);
    this.selected = 0;
    this.scene = null;
    this.functionPanel = new FunctionPanel(this);
    this.panels = [this.functionPanel, new LayersPanel(this), new SurfacesPanel(this),
      new ClipPanel(this), new LightPanel(this)];
    new SavePanel(this);
    new FitProgress(this.connection, document.getElementById('stage'));
    new OpenPanel(this);
    new LostPanel(this);
    this.addMessages();
    this.tellNote();
    this.addControls();
    this.views = new FourViews(this);
    this.line = new Timeline(this);
    this.panels.push(this.views, this.line);
  }

  /** The scene file's object of the selected layer, and what the program says of its data. */
  layer() { return this.scene.layers[this.selected]; }
  facts(i = this.selected) { return this.layerFacts?.[i]; }
  nameOf(i) {
    const layer = this.scene.layers[i];
    if (!layer.name && layer.channels) return layer.channels.map(({name}) => name).join(' + ');
    const source = layer.field ?? layer.mesh ?? layer.labels ?? {};
    return layer.name ?? (source.file ?? source.builtin ?? `layer ${i + 1}`).split('/').pop();
  }
  select(i) {
    this.selected = i;
    this.update();
  }

  /** Sends an edit; only the last one of those that wait for the same part is sent. */
  edit({layer, key, value, gesture}) {
    this.clearMessage();
    // Nobody tells the page of it before the program answers again.
    if (!this.connection.isOpen() && this.scene) {
      const target = layer === undefined ? this.scene : this.scene.layers[layer];
      if (value === null) delete target[key];
      else if (key !== 'background') target[key] = value;
    }
    this.connection.sendSoon(`edit ${layer} ${key} ${gesture}`,
      {type: 'edit', ...(layer === undefined ? {} : {layer}), key, value, gesture});
  }
  editLayer(key, value, gesture) { this.edit({layer: this.selected, key, value, gesture}); }
  editScene(key, value, gesture) { this.edit({key, value, gesture}); }
  /** Shows another part of a file: its values are others. */
  choose(message) {
    this.functionPanel.forget();
    this.connection.send(message);
  }

  /** Tells what the page says of the data that it brought. */
  tellNote() {
    const element = document.getElementById('data-note');
    const note = embeddedNote();
    element.textContent = note && `${note[0].toUpperCase()}${note.slice(1)}.`;
    element.hidden = !note;
  }

  addMessages() {
    const {connection} = this;
    connection.on('scene', (message) => this.setScene(message));
    connection.on('frame', (frame) => this.showFrame(frame));
    connection.on('probe', (probe) => this.showProbe(probe));
    connection.on('notes', ({notes}) => this.showMessage(notes.join('\n')));
    connection.on('error', ({message, no_picture: noPicture}) => {
      this.showMessage(message);
      if (noPicture) this.failed = true;
      this.tellState();
      if (this.scene) this.update();
    });
    connection.on('open', () => {
      this.lost = false;
      this.picture.resize();
    });
    connection.on('opened', () => {
      this.forgetScene();
      document.getElementById('data-note').hidden = true;
    });
    connection.on('lost', () => {
      this.lost = true;
      this.tellState();
    });
    connection.on('change', () => this.tellState());
    connection.on('current', () => this.tellState());
    connection.on('changing', () => {
      this.stale = true;
      this.tellState();
    });
    addEventListener('gestureend', () => { if (this.scene) this.update(); });
  }

  /** Another file is shown: all that was told of the one before it is of no use. */
  forgetScene() {
    this.scene = null;
    this.selected = 0;
    this.layerFacts = undefined;
    this.clearProbe();
    this.functionPanel.forget();
    this.views.forget();
    this.line.forget();
    this.timeline = undefined;
    this.stale = true;
    this.picture.resize();
  }

  setScene(message) {
    const {scene, layers, box, presets, sides} = message;
    const first = this.scene === null;
    const channels = JSON.stringify(this.layerFacts?.map((facts) => facts.channels));
    const time = this.timeline?.time;
    Object.assign(this, {timeline: message.timeline});
    // Counts are of other values then; while time goes on nobody reads them.
    if (time !== this.timeline.time && !this.line.isMoving()) this.functionPanel.forget();
    Object.assign(this, {scene, layerFacts: layers, box, presets, savable: message.savable,
      temporary: message.temporary, anatomical: message.anatomical});
    document.body.dataset.scene = 'shown';
    if (channels !== JSON.stringify(layers.map((facts) => facts.channels))) {
      this.functionPanel.forget();
    }
    document.getElementById('undo').disabled = !message.can_undo;
    document.getElementById('redo').disabled = !message.can_redo;
    if (first) {
      document.getElementById('side').replaceChildren(make('option', {value: ''}, '…'),
        ...sides.map((side) => make('option', {value: side}, side)));
      const names = scene.layers.map((_, i) => this.nameOf(i)).join(', ');
      document.getElementById('subject').textContent = names;
      document.title = `${names} – Pellucid`;
    }
    if (!gestureIsActive()) this.update();
    this.connection.sendKept();
  }

  update() {
    for (const panel of this.panels) panel.update();
  }

  showFrame(frame) {
    this.picture.show(frame);
    this.stale = this.failed = false;
    document.body.dataset.frame = frame.number;
    document.body.dataset.stride = frame.stride;
    this.unit = frame.overlay.unit;
    if (document.activeElement !== this.tolerance) this.tolerance.value = stepAt(frame.tolerance);
    document.getElementById('tolerance-text').textContent = shortNumber(frame.tolerance);
    document.getElementById('projection')
      .setAttribute('aria-pressed', String(frame.projection === 'orthographic'));
    if (frame.state === 'coarse') this.clearProbe();
    this.tellState();
  }

  /** @param {string} text of what takes long; empty: nothing does */
  setBusy(text) {
    this.busy = text;
    this.tellState();
  }

  /** Says how good the picture is. Only a picture of the scene as it is now is called exact. */
  tellState() {
    const {frame} = this.picture;
    if (this.lost) return this.showState('lost', 'Disconnected: the program does not answer');
    if (this.busy) return this.showState('waiting', this.busy);
    if (!frame || document.body.dataset.scene === 'none') {
      return this.showState('waiting', this.scene ? 'Loading…' : 'No file is open');
    }
    const tolerance = shortNumber(frame.tolerance);
    if (this.failed) return this.showState('over', 'Not up to date: there is no newer picture');
    if (frame.state === 'coarse') {
      const kind = frame.sampled ? 'Sampled' : 'Coarse';
      if (frame.stride === 1) return this.showState('coarse', `${kind}, refining…`);
      return this.showState('coarse', `${kind}: every ${frame.stride}th pixel, refining…`
        .replace('2th', '2nd'));
    }
    if (this.stale || this.connection.isAhead()) {
      return this.showState('waiting', 'Not up to date: the next picture is being made…');
    }
    if (frame.state === 'sampled') {
      return this.showState('coarse', 'Sampled: the error is not known');
    }
    if (frame.over > 0) {
      const share = `${frame.over} of ${frame.pixels} pixels`;
      return this.showState('over', `Exact, but ${share} may be over ${tolerance}`);
    }
    return this.showState('exact', `Exact: every pixel within ${tolerance}`);
  }

  showState(mark, text) {
    document.getElementById('mark').className = mark;
    const shown = document.getElementById('state-text');
    if (shown.textContent !== text) shown.textContent = text;
    const {threads} = document.body.dataset;
    if (threads) shown.title = `Rendered in this page, on ${threads} thread${threads === '1' ? '' : 's'}`;
    document.body.dataset.state = mark;
  }

  showProbe(probe) {
    const nameOf = this.scene.layers.length > 1 ? (i) => this.nameOf(i) : null;
    const text = document.getElementById('probe');
    text.textContent = probeText(probe, this.unit, nameOf);
    text.title = text.textContent;
    this.picture.markProbe(probe.position ? {x: probe.x, y: probe.y} : null);
    this.functionPanel.markSeen(probe);
  }

  /** What was probed is somewhere else now. */
  clearProbe() {
    if (!this.picture.probed) return;
    document.getElementById('probe').textContent = '';
    this.picture.markProbe(null);
    this.functionPanel.markSeen(null);
  }

  showMessage(text) {
    const message = document.getElementById('message');
    message.textContent = text;
    message.hidden = false;
    clearTimeout(this.messageTimer);
    this.messageTimer = setTimeout(() => this.clearMessage(), 12000);
  }
  clearMessage() {
    document.getElementById('message').hidden = true;
  }

  addControls() {
    const {connection} = this;
    const element = (id) => document.getElementById(id);
    const toggleProjection = () => connection.send({type: 'projection',
      name: this.picture.frame?.projection === 'perspective' ? 'orthographic' : 'perspective'});
    this.tolerance = element('tolerance');
    this.tolerance.addEventListener('input', () => connection.sendSoon('tolerance',
      {type: 'tolerance', value: toleranceAt(Number(this.tolerance.value))}));
    element('reset').addEventListener('click', () => connection.send({type: 'reset'}));
    element('projection').addEventListener('click', toggleProjection);
    element('undo').addEventListener('click', () => connection.send({type: 'undo'}));
    element('redo').addEventListener('click', () => connection.send({type: 'redo'}));
    element('side').addEventListener('change', (event) => {
      if (event.target.value) connection.send({type: 'look_from', side: event.target.value});
      event.target.value = '';
    });
    element('error-map').addEventListener('change', (event) =>
      connection.send({type: 'error_map', shown: event.target.checked}));
    addEventListener('keydown', (event) => {
      if (event.target.closest('input, select, textarea')) return;
      const control = event.ctrlKey || event.metaKey;
      if (control && event.key.toLowerCase() === 'z') {
        connection.send({type: event.shiftKey ? 'redo' : 'undo'});
        event.preventDefault();
      } else if (!control && event.key === 'r') {
        connection.send({type: 'reset'});
      } else if (!control && event.key === 'o') {
        toggleProjection();
      } else if (!control && this.scene && /^[1-7]$/.test(event.key)) {
        const side = element('side').options[Number(event.key)]?.value;
        if (side) connection.send({type: 'look_from', side});
      }
    });
  }
}

// A notebook asks whether this page answers in its frame.
if (parent !== window) parent.postMessage('pellucid', '*');
// For the console, and for tests.
window.viewer = new Viewer();
