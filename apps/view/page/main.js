// SPDX-License-Identifier: Apache-2.0
import {Connection} from './connection.js';
import {FitProgress} from './fit_progress.js';
import {FunctionPanel} from './function_panel.js';
import {Picture} from './picture.js';
import {SavePanel} from './save_panel.js';
import {ClipPanel, LayersPanel, LightPanel, SurfacesPanel, probeText} from './scene_panels.js';
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
    this.addMessages();
    this.addControls();
  }

  /** The scene file's object of the selected layer, and what the program says of its data. */
  layer() { return this.scene.layers[this.selected]; }
  facts(i = this.selected) { return this.layerFacts[i]; }
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

  addMessages() {
    const {connection} = this;
    connection.on('scene', (message) => this.setScene(message));
    connection.on('frame', (frame) => this.showFrame(frame));
    connection.on('probe', (probe) => this.showProbe(probe));
    connection.on('notes', ({notes}) => this.showMessage(notes.join('\n')));
    connection.on('error', ({message}) => {
      this.showMessage(message);
      if (this.scene) this.update();
    });
    connection.on('open', () => this.picture.resize());
    connection.on('lost', () => {
      this.showState('lost', 'Disconnected. The program has ended; start it again and open its page.');
    });
    addEventListener('gestureend', () => { if (this.scene) this.update(); });
  }

  setScene({scene, layers, box, presets, sides, can_undo: canUndo, can_redo: canRedo}) {
    const first = this.scene === null;
    const channels = JSON.stringify(this.layerFacts?.map((facts) => facts.channels));
    Object.assign(this, {scene, layerFacts: layers, box, presets});
    if (channels !== JSON.stringify(layers.map((facts) => facts.channels))) {
      this.functionPanel.forget();
    }
    document.getElementById('undo').disabled = !canUndo;
    document.getElementById('redo').disabled = !canRedo;
    if (first) {
      document.getElementById('side').append(
        ...sides.map((side) => make('option', {value: side}, side)));
      const names = scene.layers.map((_, i) => this.nameOf(i)).join(', ');
      document.getElementById('subject').textContent = names;
      document.title = `${names} – Pellucid`;
    }
    if (!gestureIsActive()) this.update();
  }

  update() {
    for (const panel of this.panels) panel.update();
  }

  showFrame(frame) {
    this.picture.show(frame);
    document.body.dataset.frame = frame.number;
    this.unit = frame.overlay.unit;
    const tolerance = shortNumber(frame.tolerance);
    if (document.activeElement !== this.tolerance) this.tolerance.value = stepAt(frame.tolerance);
    document.getElementById('tolerance-text').textContent = tolerance;
    document.getElementById('projection')
      .setAttribute('aria-pressed', String(frame.projection === 'orthographic'));
    if (frame.state === 'coarse') {
      this.clearProbe();
      this.showState('coarse', `Coarse: every ${frame.stride}th pixel, refining…`
        .replace('2th', '2nd'));
    } else if (frame.state === 'sampled') {
      this.showState('coarse', 'Sampled: the error is not known');
    } else if (frame.over > 0) {
      const share = `${frame.over} of ${frame.pixels} pixels`;
      this.showState('over', `Exact, but ${share} may be over ${tolerance}`);
    } else {
      this.showState('exact', `Exact: every pixel within ${tolerance}`);
    }
  }

  showState(mark, text) {
    document.getElementById('mark').className = mark;
    const shown = document.getElementById('state-text');
    if (shown.textContent !== text) shown.textContent = text;
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

new Viewer();
