// SPDX-License-Identifier: Apache-2.0
import {button, labelled, make, numberInput, replaceKeepingFocus, shortNumber}
  from './elements.js';
import {FilmSaver} from './film_saver.js';
import {Marks, partNames} from './marks.js';
import {Player} from './player.js';

/** Steps of time in a second at most. */
const stepRate = 12;
/** Limits of the length of a film and of its frames in a second. */
const limits = {seconds: {min: 0.001, max: 86400}, fps: {min: 0.001, max: 1000}};

/** A unit of a file without what follows its first word: "hours" of "hours since 2000-01-01". */
function shortUnit(unit) {
  return unit.length > 8 ? unit.split(/[ (]/)[0] : unit;
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
    /** What is wrong with a number that was given. */
    this.complaint = '';
    this.makeSteps(connection);
    this.makeFilm(connection);
    this.element.append(this.stepsRow, this.film);
    // Messages stand above it.
    new ResizeObserver(() => this.element.parentElement.style
      .setProperty('--timeline', `${this.element.offsetHeight}px`)).observe(this.element);
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
    const {times, time_unit: unit, times_left_out: leftOut} = this.now;
    const text = (unitText) => [shortNumber(time), unitText].filter(Boolean).join(' ') +
      ` · step ${step + 1} of ${times.length}`;
    this.stepText.value = text(shortUnit(unit)) + (leftOut > 0 ? ` (${leftOut} left out)` : '');
    this.stepText.title = text(unit) + (leftOut === 0 ? '' : `; ${leftOut} more have times beyond ` +
      '±1e30, which no scene can name');
    this.stepSlider.setAttribute('aria-valuetext', this.stepText.title);
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
    this.marks = new Marks(this);
    this.saver = new FilmSaver(this.viewer);
    this.controls = make('div', {class: 'row'});
    this.hint = make('p', {class: 'hint', 'aria-live': 'polite'});
    this.film = make('div', {class: 'list', role: 'group', 'aria-label': 'Film', hidden: true},
      make('div', {class: 'time-row'}, make('span', {}, 'Film'), this.frameButton,
        make('div', {class: 'track'}, this.marks.element, this.frameSlider), this.frameText),
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
    this.held = null;
    this.marks.forget();
    this.complaint = '';
  }

  update() {
    const {now} = this;
    if (!now || this.marks.isDragged) return;
    if (now.has_film && !this.hadFilm && !this.isOpen) {
      this.hadFilm = true;
      return this.open(true);
    }
    this.hadFilm = now.has_film;
    this.marks.takeAnswer();
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
    this.marks.update();
    this.updateControls();
    this.saver.update();
  }

  updateControls() {
    const {now} = this;
    const chosen = this.marks.chosen();
    const isThere = chosen !== null;
    const number = (key, name) => numberInput(now[key], name, (value) =>
      this.edit('length', {seconds: this.now.seconds, fps: this.now.fps, [key]: value}),
    limits[key], (text) => {
      this.complaint = text;
      this.hint.textContent = text;
    });
    replaceKeepingFocus(this.controls,
      button(isThere ? 'Update keyframe' : 'Add keyframe', () => this.setKeyframe()),
      button('Delete keyframe', () => this.marks.remove(this.marks.chosen()), {disabled: !isThere}),
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
    const chosen = this.marks.chosen();
    this.edit('set_keyframe', chosen === null ? {} : {keyframe: chosen});
  }

  hintText() {
    const {now} = this;
    if (this.complaint) return this.complaint;
    if (now.turns !== null) {
      return `The camera goes around ${now.turns === 1 ? 'once' : `${now.turns} times`}. A camera ` +
        'that you move is its new start. A keyframe makes keyframes of the turn.';
    }
    if (now.keyframes.length === 0) {
      return now.has_film ? 'The film moves the data alone.'
        : 'Choose a moment, turn or edit what you see, and add a keyframe. Without keyframes the ' +
          `film ${now.times.length > 1 ? 'shows each step of time' : 'goes around once'}.`;
    }
    const chosen = this.marks.chosen();
    if (chosen === null) {
      return 'Turn or edit what you see, and add a keyframe before you go to another moment.';
    }
    const {at, camera, parts} = now.keyframes[chosen];
    return `Keyframe ${chosen + 1} of ${now.keyframes.length}, at ${shortNumber(at)} s: ` +
      `${partNames({camera, parts})}. Arrow keys or a drag move its mark.${this.motionText()}`;
  }

  /** What one keyframe alone leaves of the motion that a film without keyframes has. */
  motionText() {
    const {keyframes, times, by_steps: bySteps, moves_data: movesData} = this.now;
    if (bySteps) return ' The film still shows each step of time, until a keyframe has another one.';
    if (keyframes.length !== 1 || movesData) return '';
    return times.length > 1 ? ' Nothing moves until another one is added: the time is held.'
      : ' Nothing moves until another one is added: the film does not go around any more.';
  }
}
