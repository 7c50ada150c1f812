// SPDX-License-Identifier: Apache-2.0
import {button, followDrag, make, shortNumber} from './elements.js';

/** Half of the thumb of a slider, in CSS pixels. */
const inset = 8;
/** Edge of a mark, in CSS pixels. */
const edge = 24;
/** Rows of marks at most, above each other where marks of one row would overlap. */
const mostRows = 3;

/**
 * Returns the row of each place, from 0 at the bottom: the lowest one that has room there. Where
 * none has, the marks overlap in the row that ends first.
 * @param {number[]} places ascending, in CSS pixels
 */
export function rowsOf(places) {
  const ends = [];
  return places.map((place) => {
    let row = ends.findIndex((end) => place - end >= edge);
    if (row < 0) row = ends.length < mostRows ? ends.length : ends.indexOf(Math.min(...ends));
    ends[row] = place;
    return row;
  });
}

/** The name of a part that keyframes hold, by its JSON pointer. */
function partName(pointer) {
  const [key, layer, ...rest] = pointer.slice(1).split('/');
  const name = key === 'layers' ? rest.join(' ') : [key, layer].filter(Boolean).join(' ');
  return name.replaceAll('_', ' ').replace('isosurfaces', 'surfaces');
}

/** The names of all parts that a keyframe holds. @returns {string} */
export function partNames({camera, parts}) {
  return [...(camera ? ['camera'] : []), ...new Set(parts.map(partName))].join(', ');
}

/** Marks of the keyframes above the slider of a film, by which they are chosen and moved. */
export class Marks {
  /** @param {import('./timeline.js').Timeline} line */
  constructor(line) {
    this.line = line;
    this.connection = line.viewer.connection;
    this.element = make('div', {class: 'marks', role: 'group', 'aria-label': 'Keyframes'});
    this.isDragged = false;
    /** The keyframe that was chosen by its mark, and its moment: {keyframe, at}. */
    this.picked = null;
    /** The change of a keyframe that the program has not answered: {keyframe, at, wanted, by}. */
    this.asked = null;
    this.connection.on('error', () => this.giveUp());
    this.connection.on('lost', () => this.giveUp());
    // Rows depend on the width.
    new ResizeObserver(() => {
      if (line.isOpen && this.now) line.update();
    }).observe(this.element);
  }

  get now() { return this.line.now; }
  get slider() { return this.line.frameSlider; }

  /** Another file is shown. */
  forget() { this.picked = this.asked = null; }

  frameOf({at}) {
    return Math.min(Math.round(at * this.now.fps), this.now.frames - 1);
  }

  /** Where a frame is along the track, for CSS. */
  place(frame) {
    const share = frame / Math.max(this.now.frames - 1, 1);
    return `calc(${inset}px + ${share} * (100% - ${2 * inset}px))`;
  }

  /** The keyframe that is updated and deleted: that of the mark that was chosen, if it is shown. */
  chosen() {
    const {keyframes, keyframe, frame} = this.now;
    const isShown = (i) => keyframes[i] !== undefined && this.frameOf(keyframes[i]) === frame;
    const {picked} = this;
    if (picked && isShown(picked.keyframe) && keyframes[picked.keyframe].at === picked.at) {
      return picked.keyframe;
    }
    // One at the very end of the film has no frame of its own, but stands at the last one.
    return keyframe ?? [keyframes.findIndex((_, i) => isShown(i))].find((i) => i >= 0) ?? null;
  }

  /** The next keyframe whose mark lies under that of another one; else that one. */
  below(i) {
    const places = this.places();
    const rows = rowsOf(places);
    const same = [...places.keys()].filter(
      (one) => rows[one] === rows[i] && Math.abs(places[one] - places[i]) < edge / 2);
    return same[(same.indexOf(i) + same.length - 1) % same.length];
  }

  /** Where the marks are, in CSS pixels. */
  places() {
    const width = this.element.clientWidth - 2 * inset;
    const last = Math.max(this.now.frames - 1, 1);
    return this.now.keyframes.map((keyframe) => this.frameOf(keyframe) / last * width);
  }

  /** Chooses a keyframe by its mark, and goes to it. */
  pick(i) {
    const {at} = this.now.keyframes[i];
    this.picked = this.focused = {keyframe: i, at};
    this.line.showFrame(this.frameOf({at}));
    this.line.update();
  }

  mark(keyframe, i, row) {
    const isChosen = this.chosen() === i;
    const parts = partNames(keyframe);
    const mark = button('◆', () => {}, {class: 'mark', 'data-keyframe': i,
      'aria-pressed': String(isChosen),
      'aria-label': `Keyframe ${i + 1} at ${shortNumber(keyframe.at)} s: ${parts}. ` +
        'Enter goes there, arrow keys move it, Delete deletes it.',
      title: `${shortNumber(keyframe.at)} s: ${parts}`,
      onpointerdown: (event) => this.pressMark(event, keyframe, i),
      onfocus: () => { this.focused = {keyframe: i, at: keyframe.at}; },
      onkeydown: (event) => this.pressKey(event, i)});
    mark.style.left = this.place(this.frameOf(keyframe));
    mark.style.bottom = `${row * edge}px`;
    return mark;
  }

  /** A click goes to a keyframe, a drag moves it. */
  pressMark(event, keyframe, i) {
    if (event.button !== 0) return;
    const mark = event.currentTarget;
    const {left, width} = this.slider.getBoundingClientRect();
    const last = this.now.frames - 1;
    let frame = this.frameOf(keyframe);
    let hasMoved = false;
    this.isDragged = true;
    followDrag(event, (next) => {
      if (Math.abs(next.clientX - event.clientX) > 3) hasMoved = true;
      if (!hasMoved) return;
      const share = (next.clientX - left - inset) / (width - 2 * inset);
      frame = Math.round(Math.min(Math.max(share, 0), 1) * last);
      mark.style.left = this.place(frame);
      this.line.tellFrame(frame);
    }, (end) => {
      this.isDragged = false;
      // Others may have changed the film meanwhile.
      const now = this.indexOf(keyframe, i);
      if (end.type !== 'pointercancel' && now !== null) {
        if (hasMoved) this.moveTo(now, frame);
        else this.pick(this.chosen() === now ? this.below(now) : now);
      }
      // A mark that stays goes back to its place.
      if (!this.asked) this.shownMarks = null;
      this.line.update();
    });
  }

  /** The number that a keyframe has now; null: it is gone. @param {number} i that it had */
  indexOf({at}, i) {
    const {keyframes} = this.now;
    if (keyframes[i]?.at === at) return i;
    const found = keyframes.findIndex((one) => one.at === at);
    return found < 0 ? null : found;
  }

  /** Asks for a keyframe at another frame. The moment follows when the program has moved it. */
  moveTo(i, frame) {
    if (this.asked || !this.connection.isOpen()) return;
    const {keyframes, fps, seconds} = this.now;
    const {at} = keyframes[i];
    if (frame === this.frameOf({at})) return;
    this.asked = {keyframe: i, at, wanted: Math.min(frame / fps, seconds), by: 0};
    this.line.edit('move_keyframe', {keyframe: i, frame});
  }

  remove(i) {
    if (this.asked || !this.connection.isOpen()) return;
    this.asked = {keyframe: i, at: this.now.keyframes[i].at, wanted: null, by: 0};
    this.line.edit('delete_keyframe', {keyframe: i});
  }

  /** The program refused what was asked: all stays as it is. */
  giveUp() {
    if (!this.asked) return;
    this.asked = null;
    this.shownMarks = null;
    this.line.update();
  }

  /** Takes the answer to what was asked, if it has come; goes on with what was pressed since. */
  takeAnswer() {
    const {asked} = this;
    if (!asked) return;
    const {keyframes, frames} = this.now;
    const isAt = (moment) => keyframes.findIndex(({at}) => Math.abs(at - moment) < 1e-9);
    if (asked.wanted === null) {
      if (keyframes[asked.keyframe]?.at !== asked.at) this.asked = null;
      return;
    }
    const i = isAt(asked.wanted);
    if (i < 0 || isAt(asked.at) >= 0) return;
    this.asked = null;
    const {at} = keyframes[i];
    const frame = this.frameOf({at});
    if (this.focused?.at === asked.at) this.focused = {keyframe: i, at};
    this.picked = {keyframe: i, at};
    const next = Math.min(Math.max(frame + asked.by, 0), frames - 1);
    if (next === frame) this.line.showFrame(frame);
    else this.moveTo(i, next);
  }

  pressKey(event, i) {
    const by = (event.shiftKey ? 10 : 1) * ({ArrowLeft: -1, ArrowRight: 1}[event.key] ?? 0);
    if (by !== 0) {
      // The next move counts from where the mark is then.
      if (this.asked?.keyframe === i) this.asked.by += by;
      const frame = this.frameOf(this.now.keyframes[i]) + by;
      this.moveTo(i, Math.min(Math.max(frame, 0), this.now.frames - 1));
    } else if (event.key === 'Delete' || event.key === 'Backspace') {
      this.remove(i);
    } else if (event.key === 'Enter' || event.key === ' ') {
      this.pick(i);
    } else {
      return;
    }
    event.preventDefault();
  }

  update() {
    const {now} = this;
    const rows = rowsOf(this.places());
    const key = JSON.stringify([now.keyframes, this.chosen(), now.fps, now.frames, rows]);
    if (key === this.shownMarks) return;
    this.shownMarks = key;
    // The focus stays at its keyframe; where that is gone, at the one in its place.
    const had = this.element.contains(document.activeElement) ? this.focused : null;
    this.element.replaceChildren(
      ...now.keyframes.map((keyframe, i) => this.mark(keyframe, i, rows[i])));
    this.element.parentElement.style.setProperty('--rows', Math.max(...rows, 0) + 1);
    if (!had) return;
    const next = this.indexOf(had, had.keyframe) ??
      Math.min(had.keyframe, now.keyframes.length - 1);
    (this.element.children[next] ?? this.slider).focus();
  }
}
