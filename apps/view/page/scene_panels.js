// SPDX-License-Identifier: Apache-2.0
import {nextDirection, withLight, withoutLight} from './lights.js';
import {greyColors, windowOf} from './windows.js';
import {button, choice, colorInput, gestureIsActive, labelled, make, newGesture, numberInput,
  replaceKeepingFocus, shortNumber, slider} from './elements.js';

const axisNames = ['x', 'y', 'z'];
const white = [1, 1, 1];
/** Volume files whose arrays have names. */
const namesArrays = /\.(p?vt[ikr]|h5|hdf5?|he5|vtkhdf|nc4?|cdf|npz|vdb|zarr)$/i;

/** A panel that is made anew from the scene. */
class Panel {
  constructor(viewer, id) {
    this.viewer = viewer;
    this.content = document.querySelector(`#${id} .content`);
  }
  update() {
    if (!gestureIsActive()) replaceKeepingFocus(this.content, ...this.parts());
  }
  /** Edits one element of a list of the layer, or of the scene. */
  changer(list, i, send) {
    return (parts, gesture = newGesture()) => {
      const next = structuredClone(list);
      for (const [key, value] of Object.entries(parts)) {
        if (value === null) delete next[i][key];
        else next[i][key] = value;
      }
      list[i] = next[i];
      send(next, gesture);
    };
  }
  without(list, i) {
    const rest = list.filter((_, k) => k !== i);
    return rest.length > 0 ? rest : null;
  }
}

/** Layers on and off, their projection, and the part of their file that is shown. */
export class LayersPanel extends Panel {
  constructor(viewer) {
    super(viewer, 'layers-panel');
  }

  parts() {
    const {viewer} = this;
    return viewer.scene.layers.map((layer, i) => {
      const name = viewer.nameOf(i);
      const edit = (key, value) => viewer.edit({layer: i, key, value, gesture: newGesture()});
      const rows = [make('div', {class: 'row'},
        labelled('', make('input', {type: 'checkbox', checked: layer.visible ?? true,
          'aria-label': `Show ${name}`,
          onchange: (event) => edit('visible', event.target.checked)})),
        button(name, () => viewer.select(i), {'aria-pressed': String(i === viewer.selected),
          'aria-label': `Edit ${name}`}))];
      if (layer.field || layer.mesh) {
        const kinds = ['maximum', 'minimum', 'mean', 'sum'].map((kind) => [kind, kind]);
        rows.push(labelled('Along a ray', choice(layer.projection ?? '',
          [['', 'the integral'], ...kinds], `Projection of ${name}`,
          (kind) => edit('projection', kind || null))));
      }
      rows.push(...this.fileRows(layer, i, name));
      return make('div', {class: 'item'}, ...rows);
    });
  }

  fileRows(layer, i, name) {
    const {file, components, arrays, times} = this.viewer.facts(i);
    const {follows, time: timeOfAll} = this.viewer.timeline;
    const rows = [];
    if (file && arrays.length === 0 && (layer.mesh || namesArrays.test(layer.field?.file ?? ''))) {
      rows.push(make('div', {class: 'row'}, button('Other arrays and times…',
        () => this.viewer.connection.send({type: 'list_file', layer: i}),
        {title: 'Reads all of the file for a list of them'})));
    }
    if (times.length > 1) {
      const shown = layer.mesh.time ?? (follows[i] ? timeOfAll : times[0]);
      const nearest = times.reduce((a, b) => (Math.abs(b - shown) < Math.abs(a - shown) ? b : a));
      rows.push(labelled('Time', choice(String(nearest),
        times.map((time) => [String(time), shortNumber(time)]), `Time of ${name}`,
        (time) => this.viewer.choose({type: 'time', layer: i, time: Number(time)}))));
    }
    if (arrays.length > 1) {
      const shown = layer.mesh?.channels?.[0]?.array ?? layer.mesh?.array ?? layer.field?.array;
      rows.push(labelled('Array', choice(shown ?? arrays[0],
        arrays.map((array) => [array, array]), `Array of ${name}`,
        (array) => this.viewer.choose({type: 'array', layer: i, array}))));
    }
    if (components > 1 && !follows[i]) {
      rows.push(labelled(`Step or component, 0 to ${components - 1}`, numberInput(
        layer.field?.component ?? 0, `Component of ${name}`, (component) => this.viewer.choose(
          {type: 'component', layer: i, component: Math.round(component)}),
        {min: 0, max: components - 1, step: 1})));
    }
    return rows;
  }
}

/** Isosurfaces and slices of the selected layer. */
export class SurfacesPanel extends Panel {
  constructor(viewer) {
    super(viewer, 'surfaces-panel');
  }

  parts() {
    const {viewer} = this;
    const layer = viewer.layer();
    if (layer.labels || layer.projection) {
      return [make('p', {class: 'empty'}, 'Labels and projected layers have no surfaces.')];
    }
    const surfaces = layer.isosurfaces ?? [], slices = layer.slices ?? [];
    const [least, most] = viewer.facts().range;
    const add = () => {
      const taken = new Set(surfaces.map((surface) => surface.value));
      let value = (least + most) / 2;
      while (taken.has(value)) value = (value + most) / 2;
      const gesture = newGesture();
      viewer.editLayer('isosurfaces', [...surfaces, {value, color: [1, 0.8, 0.6], opacity: 1}],
        gesture);
      // As on the command line: without light a surface is flat.
      if (surfaces.length === 0 && !layer.shading) viewer.editLayer('shading', {}, gesture);
    };
    return [
      ...surfaces.map((surface, i) => this.surface(surfaces, surface, i, least, most)),
      ...slices.map((slice, i) => this.slice(slices, slice, i)),
      make('div', {class: 'row'}, button('Add an isosurface', add),
        ...axisNames.map((axis, a) => button(`Add a slice across ${axis}`,
          () => this.addSlice(slices, a)))),
      make('p', {class: 'hint'}, surfaces.length > 0
        ? 'An isosurface is also dragged along the histogram.'
        : 'Surfaces are lit as the layer is shaded.')];
  }

  surface(surfaces, surface, i, least, most) {
    const {viewer} = this;
    const change = this.changer(surfaces, i,
      (next, gesture) => viewer.editLayer('isosurfaces', next, gesture));
    const name = `isosurface ${i + 1}`;
    return make('div', {class: 'item'}, make('div', {class: 'row'},
      labelled('Value', numberInput(surface.value, `Value of ${name}`,
        (value) => change({value}))),
      surface.colors ? '' : colorInput(surface.color ?? white, `Color of ${name}`,
        (color, gesture) => change({color}, gesture)),
      button('Remove', () => viewer.editLayer('isosurfaces', this.without(surfaces, i),
        newGesture()), {'aria-label': `Remove ${name}`})),
    labelled('Value', slider(surface.value, least, most, `Slide the value of ${name}`,
      (value, gesture) => change({value}, gesture)), 'inline grow'),
    labelled('Opacity', slider(surface.opacity ?? 1, 0, 1, `Opacity of ${name}`,
      (opacity, gesture) => change({opacity}, gesture)), 'inline grow'));
  }

  addSlice(slices, axis) {
    const {lower, upper} = this.viewer.box;
    const point = lower.map((low, a) => (low + upper[a]) / 2);
    const normal = [0, 1, 2].map((a) => (a === axis ? 1 : 0));
    const grey = slices.map(windowOf).find(Boolean) ?? this.viewer.functionPanel.middleRange();
    this.viewer.editLayer('slices', [...slices, {point, normal, opacity: 1,
      colors: greyColors(...grey)}], newGesture());
  }

  /** Colors of a slice. All grey slices of a layer have one window. */
  sliceColors(slices, slice, i, name) {
    const {viewer} = this;
    const shown = windowOf(slice);
    const kind = shown ? 'grey' : 'function';
    const send = (next, gesture) => viewer.editLayer('slices', next, gesture);
    const set = (k, colors) => slices.map((old, j) => {
      if (!k(old, j)) return old;
      const {colors: unused, ...rest} = old;
      return colors ? {...rest, colors} : rest;
    });
    const rows = [labelled('Colors', choice(kind, [['grey', 'grey, by a window'],
      ['function', 'of the function']], `Colors of ${name}`, (next) => send(set((_, j) => j === i,
      next === 'grey' ? greyColors(...viewer.functionPanel.middleRange()) : null), newGesture())))];
    if (!shown) return rows;
    const [lower, upper] = shown;
    const level = (lower + upper) / 2, width = upper - lower;
    const setWindow = (nextLevel, nextWidth, gesture) => send(set(windowOf,
      greyColors(nextLevel - nextWidth / 2, nextLevel + nextWidth / 2)), gesture);
    const [least, most] = viewer.facts().range;
    const least0 = Math.min(least, lower), most0 = Math.max(most, upper);
    const thinnest = (most0 - least0) / 1000 || 1e-6;
    rows.push(make('div', {class: 'row'},
      labelled('Level', numberInput(level, `Level of ${name}`,
        (next) => setWindow(next, width, newGesture()))),
      labelled('Window', numberInput(width, `Window of ${name}`,
        (next) => setWindow(level, Math.max(next, thinnest), newGesture()), {min: 0}))),
    labelled('Level', slider(level, least0, most0, `Slide the level of ${name}`,
      (next, gesture) => setWindow(next, width, gesture)), 'inline grow'),
    labelled('Window', slider(width, thinnest, most0 - least0, `Slide the window of ${name}`,
      (next, gesture) => setWindow(level, next, gesture)), 'inline grow'));
    return rows;
  }

  slice(slices, slice, i) {
    const {viewer} = this;
    const change = this.changer(slices, i,
      (next, gesture) => viewer.editLayer('slices', next, gesture));
    const axis = slice.normal.findIndex((part) => part !== 0);
    const straight = slice.normal.filter((part) => part !== 0).length === 1;
    const name = straight ? `Slice across ${axisNames[axis]}` : `Oblique slice ${i + 1}`;
    const rows = [make('div', {class: 'row'}, make('span', {}, name),
      button('Remove', () => viewer.editLayer('slices', this.without(slices, i), newGesture()),
        {'aria-label': `Remove ${name}`}))];
    if (straight) {
      rows.push(labelled('Position', slider(slice.point[axis], viewer.box.lower[axis],
        viewer.box.upper[axis], `Position of ${name}`, (position, gesture) => {
          const point = [...slice.point];
          point[axis] = position;
          change({point}, gesture);
        }), 'inline grow'));
    }
    rows.push(...this.sliceColors(slices, slice, i, name));
    rows.push(labelled('Opacity', slider(slice.opacity ?? 1, 0, 1, `Opacity of ${name}`,
      (opacity, gesture) => change({opacity}, gesture)), 'inline grow'));
    return make('div', {class: 'item'}, ...rows);
  }
}

/** Shapes that limit what is shown of all layers. */
export class ClipPanel extends Panel {
  constructor(viewer) {
    super(viewer, 'clip-panel');
  }

  parts() {
    const {viewer} = this;
    const clips = viewer.scene.clip ?? [];
    const {lower, upper} = viewer.box;
    const middle = lower.map((low, a) => (low + upper[a]) / 2);
    const radius = Math.hypot(...lower.map((low, a) => upper[a] - low)) / 2;
    const add = (shape) => () => viewer.editScene('clip', [...clips, shape], newGesture());
    return [
      ...clips.map((clip, i) => this.clip(clips, clip, i)),
      make('div', {class: 'row'},
        button('Add a box', add({box: {lower, upper}})),
        button('Add a plane', add({plane: {point: middle, normal: [0, 1, 0]}})),
        button('Add a sphere', add({sphere: {center: middle, radius: radius * 0.6}}))),
      make('p', {class: 'hint'}, 'Drag the handles on the picture, or edit the numbers.')];
  }

  clip(clips, clip, i) {
    const {viewer} = this;
    const change = this.changer(clips, i,
      (next, gesture) => viewer.editScene('clip', next, gesture));
    const kind = Object.keys(clip).find((key) => key !== 'keep');
    const name = `${kind} ${i + 1}`;
    const shape = clip[kind];
    const numbers = Object.entries(shape).map(([key, value]) => {
      const set = (next) => change({[kind]: {...shape, [key]: next}});
      const inputs = Array.isArray(value)
        ? value.map((number, a) => numberInput(number, `${key} ${axisNames[a]} of ${name}`,
          (next) => set(value.map((old, b) => (a === b ? next : old)))))
        : [numberInput(value, `${key} of ${name}`, set)];
      return make('div', {class: 'row'}, make('span', {class: 'key'}, key), ...inputs);
    });
    const flip = kind === 'plane'
      ? button('Flip', () => change({plane: {...shape, normal: shape.normal.map((n) => -n)}}),
        {'aria-label': `Flip ${name}`})
      : choice(clip.keep ?? 'inside', [['inside', 'keep inside'], ['outside', 'cut away']],
        `What ${name} keeps`, (keep) => change({keep}));
    return make('div', {class: 'item'}, make('div', {class: 'row'}, make('span', {}, name), flip,
      button('Remove', () => viewer.editScene('clip', this.without(clips, i), newGesture()),
        {'aria-label': `Remove ${name}`})), ...numbers);
  }
}

/** The shading of the selected layer, the lights of the scene, and what is behind it. */
export class LightPanel extends Panel {
  constructor(viewer) {
    super(viewer, 'light-panel');
  }

  parts() {
    const {viewer} = this;
    const layer = viewer.layer();
    const lights = viewer.scene.lights ?? [{type: 'head', color: white}];
    const background = viewer.scene.image.background;
    const parts = layer.labels || layer.projection ? [] : this.shading(layer);
    parts.push(...lights.map((light, i) => this.light(lights, light, i)),
      make('div', {class: 'row'}, button('Add a light', () => viewer.editScene('lights',
        withLight(lights, {type: 'directional',
          direction: nextDirection(viewer.picture.frame?.camera, lights.length)}),
        newGesture())), make('span', {class: 'hint'}, 'Lights share their brightness.')),
      make('div', {class: 'row'}, labelled('Background',
        colorInput(background?.top ?? background ?? [0.01, 0.01, 0.02], 'Background',
          (color, gesture) => viewer.editScene('background', color, gesture))),
      button('Default', () => viewer.editScene('background', null, newGesture())),
      button('Transparent', () => viewer.editScene('background', 'transparent', newGesture()))),
    make('span', {class: 'hint'}, background === undefined ? 'a dark gradient'
      : background === null ? 'a saved picture is transparent' : ''));
    return parts;
  }

  shading(layer) {
    const {viewer} = this;
    const shading = layer.shading;
    const set = (value, gesture = newGesture()) => viewer.editLayer('shading', value, gesture);
    const rows = [labelled('', make('input', {type: 'checkbox', checked: Boolean(shading),
      'aria-label': 'Shade the layer',
      onchange: (event) => set(event.target.checked ? {} : null)}))];
    rows[0].append('Shade the layer');
    if (shading) {
      const limits = {ambient: 1, diffuse: 1.5, specular: 1.5, power: 100};
      for (const [key, most] of Object.entries(limits)) {
        rows.push(labelled(key, slider(shading[key], key === 'power' ? 1 : 0, most,
          `${key} part of the light`, (value, gesture) => {
            shading[key] = value;
            set({...shading}, gesture);
          }), 'inline grow'));
      }
    }
    return [make('div', {class: 'item'}, ...rows)];
  }

  light(lights, light, i) {
    const {viewer} = this;
    const send = (next, gesture) => viewer.editScene('lights', next, gesture);
    const change = this.changer(lights, i, send);
    const name = `light ${i + 1}`;
    const place = {directional: ['direction', [0, 1, -1]], point: ['position', viewer.box.upper]};
    const kinds = [['head', 'at the eye'], ['directional', 'from far away'], ['point', 'at a point']];
    const rows = [make('div', {class: 'row'},
      choice(light.type, kinds, `Kind of ${name}`, (type) => {
        const next = {type, color: light.color ?? white};
        if (place[type]) next[place[type][0]] = place[type][1];
        send(lights.map((old, k) => (k === i ? next : old)), newGesture());
      }),
      colorInput(light.color ?? white, `Color of ${name}`,
        (color, gesture) => change({color}, gesture)),
      button('Remove', () => send(withoutLight(lights, i), newGesture()),
        {'aria-label': `Remove ${name}`}))];
    if (place[light.type]) {
      const [key] = place[light.type];
      rows.push(make('div', {class: 'row'}, key, ...light[key].map((number, a) =>
        numberInput(number, `${key} ${axisNames[a]} of ${name}`, (next) =>
          change({[key]: light[key].map((old, b) => (a === b ? next : old))})))));
    }
    return make('div', {class: 'item'}, ...rows);
  }
}

/**
 * @param {Object} probe a message "probe"
 * @param {string} unit of length
 * @param {?function(number): string} nameOf a layer; null if there is only one
 * @returns {string}
 */
export function probeText(probe, unit, nameOf) {
  const depth = probe.optical_depth === null ? '∞' : shortNumber(probe.optical_depth);
  if (!probe.position) return `nothing in front · optical depth ${depth}`;
  const position = probe.position.map(shortNumber).join(', ');
  const values = probe.values.map(({channel, value}) => `${channel} ${shortNumber(value)}`);
  const layer = probe.layer === undefined || !nameOf ? '' : ` · ${nameOf(probe.layer)}`;
  return `(${position})${unit ? ' ' + unit : ''} · ${values.join(', ')} · ` +
    `optical depth ${depth}${layer}`;
}
