// SPDX-License-Identifier: Apache-2.0
import {button, followDrag, labelled, make, numberInput, replaceKeepingFocus, shortNumber}
  from './elements.js';
import {FilmSaver} from './film_saver.js';
import {Player} from './player.js';

/** Steps of time in a second at most. */
const stepRate = 12;
/** Limits of the length of a film and of its frames in a second. */
const limits = {seconds: {min: 0.001, max: 86400}, fps: {min: 0.001, max: 1000}};
/** Half of the thumb of a slider, in CSS pixels. */
const inset = 8;

/** The name of a part that keyframes hold, by its JSON pointer. */
function partName(pointer) {
  const [key, layer, ...rest] = pointer.slice(1).split('/');
  const name = key === 'layers' ? rest.join(' ') : [key, layer].filter(Boolean).join(' ');
  return name.replaceAll('_', ' ').replace('isosurfaces', 'surfaces');
}

/** The time of the data, and the film with its keyframes. */
export class Timeline {
  /** @param {import('./main.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    const {connection} = viewer;
    this.element = document.getElementById('timeline');
    this.button = document.getElementById('film');
    this.isOpen = false;
    /** The slider that is being moved. */
    this.held = null;
    /** The keyframe that was chosen by its mark, and its moment: {keyframe, at}. */
    this.picked = null;
    /** The change of a keyframe that the program has not answered: {keyframe, at, wanted, by}. */
    this.asked = null;
    /** What is wrong with a number that was given. */
    this.complaint = '';
    this.makeSteps(connection);
    this.makeFilm(connection);
    this.element.append(this.stepsRow, this.film);
    // Messages stand above it.
    new ResizeObserver(() => this.element.parentElement.style
      .setProperty('--timeline', `${this.element.offsetHeight}px`)).observe(this.element);
    connection.on('error', () => this.giveUp());
    connection.on('lost', () => this.giveUp());
    this.button.addEventListener('click', () => this.open(!this.isOpen));
    addEventListener('keydown', (event) => {
      if (event.target.closest('input, select, textarea') || !viewer.scene) return;
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.key === 't') this.open(!this.isOpen);
    });
  }

  get now() { return this.viewer.timeline; }
  /** Whether the time goes on, or is being moved. */
  isMoving() { return this.steps.isPlaying || this.frames.isPlaying || this.held !== null; }

  // --- The time of the data.

  makeSteps(connection) {
    this.steps = new Player(connection, {skips: false, rate: () => stepRate,
      position: () => this.step(), count: () => this.now.times.length,
      show: (step) => this.showStep(step),
      changed: (isPlaying) => this.playingChanged(this.stepButton, isPlaying)});
    this.stepSlider = this.slider('time', 'Time of the data', this.steps);
    this.stepText = make('output', {for: 'time'});
    this.stepButton = this.playButton('the steps of time', this.steps);
    this.stepsRow = make('div', {class: 'time-row', role: 'group', 'aria-label': 'Time'},
      make('span', {}, 'Time'), this.stepButton, this.stepSlider, this.stepText);
  }

  /** The number of the step that is shown: the nearest one to the time. */
  step() {
    const {times, time} = this.now;
    return times.reduce((best, one, i) =>
      (Math.abs(one - time) < Math.abs(times[best] - time) ? i : best), 0);
  }

  showStep(step) {
    const {times} = this.now;
    this.stepSlider.value = step;
    this.tellStep(times[step], step);
    this.viewer.connection.sendSoon('time', {type: 'scene_time', time: times[step]});
  }

  tellStep(time, step) {
    this.stepText.value = `${shortNumber(time)} · step ${step + 1} of ${this.now.times.length}`;
    this.stepSlider.setAttribute('aria-valuetext', this.stepText.value);
  }

  // --- The film.

  makeFilm(connection) {
    this.frames = new Player(connection, {skips: true, rate: () => this.now.fps,
      position: () => this.now.frame, count: () => this.now.frames,
      show: (frame) => this.showFrame(frame),
      changed: (isPlaying) => this.playingChanged(this.frameButton, isPlaying)});
    this.frameSlider = this.slider('moment', 'Moment of the film', this.frames);
    this.frameText = make('output', {for: 'moment'});
    this.frameButton = this.playButton('the film', this.frames);
    this.marks = make('div', {class: 'marks', role: 'group', 'aria-label': 'Keyframes'});
    this.saver = new FilmSaver(this.viewer);
    this.controls = make('div', {class: 'row'});
    this.hint = make('p', {class: 'hint', 'aria-live': 'polite'});
    this.film = make('div', {class: 'list', role: 'group', 'aria-label': 'Film', hidden: true},
      make('div', {class: 'time-row'}, make('span', {}, 'Film'), this.frameButton,
        make('div', {class: 'track'}, this.marks, this.frameSlider), this.frameText),
      this.controls, this.hint, this.saver.element);
  }

  /** @param {boolean} isOpen whether the film is shown */
  open(isOpen) {
    this.isOpen = isOpen;
    this.film.hidden = !isOpen;
    this.button.setAttribute('aria-pressed', String(isOpen));
    document.body.dataset.film = isOpen ? 'open' : 'shut';
    if (!isOpen) this.frames.stop();
    this.update();
  }

  edit(action, more = {}) {
    this.complaint = '';
    this.viewer.clearMessage();
    this.viewer.connection.send({type: 'film', action, ...more});
  }

  showFrame(frame) {
    this.complaint = '';
    this.frameSlider.value = frame;
    this.tellFrame(frame);
    this.viewer.connection.sendSoon('moment', {type: 'film_frame', frame});
  }

  tellFrame(frame) {
    const {fps, frames, seconds} = this.now;
    this.frameText.value = `${(frame / fps).toFixed(2)} of ${shortNumber(seconds)} s`;
    this.frameSlider.setAttribute('aria-valuetext',
      `${(frame / fps).toFixed(2)} s, frame ${frame + 1} of ${frames}`);
  }

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

  /** The next keyframe whose mark is at the same place, behind that of another; else that one. */
  below(i) {
    const {keyframes} = this.now;
    const place = this.frameOf(keyframes[i]);
    const same = [...keyframes.keys()].filter((one) => this.frameOf(keyframes[one]) === place);
    return same[(same.indexOf(i) + same.length - 1) % same.length];
  }

  /** Chooses a keyframe by its mark, and goes to it. */
  pick(i) {
    const {at} = this.now.keyframes[i];
    this.picked = this.focused = {keyframe: i, at};
    this.showFrame(this.frameOf({at}));
    this.update();
  }

  mark(keyframe, i) {
    const isChosen = this.chosen() === i;
    const parts = [...(keyframe.camera ? ['camera'] : []), ...keyframe.parts.map(partName)];
    const mark = button('◆', () => {}, {class: 'mark', 'data-keyframe': i,
      'aria-pressed': String(isChosen),
      'aria-label': `Keyframe ${i + 1} at ${shortNumber(keyframe.at)} s: ${parts.join(', ')}. ` +
        'Enter goes there, arrow keys move it, Delete deletes it.',
      title: `${shortNumber(keyframe.at)} s: ${parts.join(', ')}`,
      onpointerdown: (event) => this.pressMark(event, keyframe, i),
      onfocus: () => { this.focused = {keyframe: i, at: keyframe.at}; },
      onkeydown: (event) => this.pressKey(event, i)});
    mark.style.left = this.place(this.frameOf(keyframe));
    return mark;
  }

  /** A click goes to a keyframe, a drag moves it. */
  pressMark(event, keyframe, i) {
    if (event.button !== 0) return;
    const mark = event.currentTarget;
    const {left, width} = this.frameSlider.getBoundingClientRect();
    const last = this.now.frames - 1;
    let frame = this.frameOf(keyframe);
    let hasMoved = false;
    this.dragging = true;
    followDrag(event, (next) => {
      if (Math.abs(next.clientX - event.clientX) > 3) hasMoved = true;
      if (!hasMoved) return;
      const share = (next.clientX - left - inset) / (width - 2 * inset);
      frame = Math.round(Math.min(Math.max(share, 0), 1) * last);
      mark.style.left = this.place(frame);
      this.tellFrame(frame);
    }, (end) => {
      this.dragging = false;
      // Others may have changed the film meanwhile.
      const now = this.indexOf(keyframe, i);
      if (end.type !== 'pointercancel' && now !== null) {
        if (hasMoved) this.moveTo(now, frame);
        else this.pick(this.chosen() === now ? this.below(now) : now);
      }
      // A mark that stays goes back to its place.
      if (!this.asked) this.shownMarks = null;
      this.update();
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
    if (this.asked || !this.viewer.connection.isOpen()) return;
    const {keyframes, fps, seconds} = this.now;
    const {at} = keyframes[i];
    if (frame === this.frameOf({at})) return;
    this.asked = {keyframe: i, at, wanted: Math.min(frame / fps, seconds), by: 0};
    this.edit('move_keyframe', {keyframe: i, frame});
  }

  remove(i) {
    if (this.asked || !this.viewer.connection.isOpen()) return;
    this.asked = {keyframe: i, at: this.now.keyframes[i].at, wanted: null, by: 0};
    this.edit('delete_keyframe', {keyframe: i});
  }

  /** The program refused what was asked: all stays as it is. */
  giveUp() {
    if (!this.asked) return;
    this.asked = null;
    this.shownMarks = null;
    this.update();
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
    if (next === frame) this.showFrame(frame);
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

  // --- Both.

  hold(slider) {
    this.steps.stop();
    this.frames.stop();
    this.held = slider;
  }
  letGo() {
    this.held = null;
    this.cameToRest();
  }
  /** Counts of the values are of another time. */
  cameToRest() {
    if (!this.viewer.scene) return;
    this.viewer.functionPanel.forget();
    this.viewer.update();
  }

  /** A slider of the positions of a player. */
  slider(id, name, player) {
    const input = make('input', {type: 'range', min: 0, step: 1, id, 'aria-label': name,
      oninput: () => {
        this.hold(input);
        player.show(Number(input.value));
      },
      onchange: () => this.letGo(),
      onkeydown: (event) => this.playByKey(event, player)});
    return input;
  }

  playButton(what, player) {
    return button('▶', () => player.toggle(), {class: 'play', 'aria-label': `Play ${what}`,
      title: `Play ${what} (space)`, 'data-what': what});
  }

  playByKey(event, player) {
    if (event.key !== ' ') return;
    event.preventDefault();
    player.toggle();
  }

  playingChanged(element, isPlaying) {
    const text = `${isPlaying ? 'Pause' : 'Play'} ${element.dataset.what}`;
    element.textContent = isPlaying ? '❚❚' : '▶';
    element.setAttribute('aria-label', text);
    element.title = `${text} (space)`;
    if (!isPlaying) this.cameToRest();
  }

  /** Another file is shown. */
  forget() {
    this.steps.stop();
    this.frames.stop();
    this.hadFilm = false;
    this.held = this.picked = this.asked = null;
    this.complaint = '';
  }

  update() {
    const {now} = this;
    if (!now || this.dragging) return;
    if (now.has_film && !this.hadFilm && !this.isOpen) {
      this.hadFilm = true;
      return this.open(true);
    }
    this.hadFilm = now.has_film;
    this.takeAnswer();
    this.element.hidden = now.times.length < 2 && !this.isOpen;
    this.stepsRow.hidden = now.times.length < 2;
    this.stepSlider.max = now.times.length - 1;
    this.frameSlider.max = now.frames - 1;
    // While a slider moves, what the program tells is of a position before.
    if (this.held !== this.stepSlider && !this.steps.isPlaying && now.times.length > 0) {
      const step = this.step();
      this.stepSlider.value = step;
      this.tellStep(now.time, step);
    }
    if (this.held !== this.frameSlider && !this.frames.isPlaying) {
      this.frameSlider.value = now.frame;
      this.tellFrame(now.frame);
    }
    if (!this.isOpen) return;
    this.updateMarks();
    this.updateControls();
    this.saver.update();
  }

  updateMarks() {
    const {now} = this;
    const key = JSON.stringify([now.keyframes, this.chosen(), now.fps, now.frames]);
    if (key === this.shownMarks) return;
    this.shownMarks = key;
    // The focus stays at its keyframe; where that is gone, at the one in its place.
    const had = this.marks.contains(document.activeElement) ? this.focused : null;
    this.marks.replaceChildren(...now.keyframes.map((keyframe, i) => this.mark(keyframe, i)));
    if (!had) return;
    const next = this.indexOf(had, had.keyframe) ??
      Math.min(had.keyframe, now.keyframes.length - 1);
    (this.marks.children[next] ?? this.frameSlider).focus();
  }

  updateControls() {
    const {now} = this;
    const chosen = this.chosen();
    const isThere = chosen !== null;
    const number = (key, name) => numberInput(now[key], name, (value) =>
      this.edit('length', {seconds: this.now.seconds, fps: this.now.fps, [key]: value}),
    limits[key], (text) => {
      this.complaint = text;
      this.hint.textContent = text;
    });
    replaceKeepingFocus(this.controls,
      button(isThere ? 'Update keyframe' : 'Add keyframe', () => this.setKeyframe()),
      button('Delete keyframe', () => this.remove(this.chosen()), {disabled: !isThere}),
      labelled('Seconds', number('seconds', 'Length of the film in seconds')),
      labelled('Frames a second', number('fps', 'Frames of the film in a second')),
      button('Turntable', () => {
        this.edit('turntable', {turns: 1});
        this.showFrame(0);
      }, {'aria-pressed': String(now.turns !== null),
        title: 'The camera goes around once, from where it is'}),
      button('Remove film', () => this.edit('remove'), {disabled: !now.has_film}),
      button('Save the film…', () => this.saver.toggle(),
        {'aria-expanded': String(!this.saver.element.hidden)}));
    this.hint.textContent = this.hintText();
  }

  setKeyframe() {
    const chosen = this.chosen();
    this.edit('set_keyframe', chosen === null ? {} : {keyframe: chosen});
  }

  hintText() {
    const {now} = this;
    if (this.complaint) return this.complaint;
    if (now.turns !== null) {
      return `The camera goes around ${now.turns === 1 ? 'once' : `${now.turns} times`}. A camera ` +
        'that you move is its new start.';
    }
    if (now.keyframes.length === 0) {
      return now.has_film ? 'The film moves the data alone.'
        : 'Choose a moment, turn or edit what you see, and add a keyframe. Without keyframes the ' +
          `film ${now.times.length > 1 ? 'shows each step of time' : 'goes around once'}.`;
    }
    const chosen = this.chosen();
    if (chosen === null) {
      return 'Turn or edit what you see, and add a keyframe before you go to another moment.';
    }
    const {at, camera, parts} = now.keyframes[chosen];
    return `Keyframe ${chosen + 1} of ${now.keyframes.length}, at ${shortNumber(at)} s: ` +
      `${[...(camera ? ['camera'] : []), ...new Set(parts.map(partName))].join(', ')}. Arrow keys ` +
      'or a drag move its mark.';
  }
}
