// SPDX-License-Identifier: Apache-2.0
import {button, choice, labelled, make, replaceKeepingFocus, shortNumber} from './elements.js';

const formatNames = {webm: 'Video, .webm', mp4: 'Video, .mp4', zip: 'Numbered PNG, .zip'};
const sentence = 'A page without a program saves no film. Save the scene, and call ' +
  'pellucid animate scene.json -o film.webm.';

function durationText(seconds) {
  const whole = Math.round(seconds);
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${whole % 60} s`;
  return `${Math.floor(whole / 3600)} h ${Math.floor(whole % 3600 / 60)} min`;
}

/** Limits of the numbers that are asked for. */
const limits = {
  width: {min: 1, max: 8192, step: 1},
  height: {min: 1, max: 8192, step: 1},
  tolerance: {min: 1e-7, max: 1, step: 'any'},
};

/**
 * Asks for size, tolerance and format of a film, and tells how far it is: the film of any page, as
 * each of them may cancel it.
 */
export class FilmSaver {
  /** @param {import('./main.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    /** 'none', 'asked' until the program answers, or 'going' while a film is being saved. */
    this.state = 'none';
    this.bar = make('progress', {max: 1, 'aria-label': 'Part of the film that is done'});
    this.text = make('span', {role: 'status'});
    this.form = make('div', {class: 'row'});
    this.way = make('div', {class: 'row', hidden: true}, this.bar, this.text,
      button('Cancel the film', () => this.cancel()));
    this.said = make('p', {class: 'hint', role: 'status'});
    this.element = make('div', {id: 'film-saver', class: 'list', role: 'group',
      'aria-label': 'Save the film', hidden: true}, this.form, this.way, this.said);
    const {connection} = viewer;
    connection.on('film_progress', (progress) => this.showProgress(progress));
    connection.on('film_ended', ({failure, page}) => this.ended(failure, page));
    connection.on('file', ({name}) => {
      if (name.startsWith('film.')) connection.send({type: 'film_taken'});
    });
    connection.on('error', ({message}) => { if (this.state === 'asked') this.end(message); });
    connection.on('lost', () => {
      if (this.state === 'none') return;
      this.end('The connection was lost, and no film came. If the program goes on, so does the ' +
        'film: this page, or another one, gets it when it is connected again.');
    });
  }

  toggle() {
    this.element.hidden = !this.element.hidden;
    this.update();
    this.viewer.line.updateControls();
    if (!this.element.hidden) this.form.querySelector('input')?.focus();
  }

  update() {
    if (this.element.hidden || this.isBuilt || !this.viewer.timeline) return;
    const {formats} = this.viewer.timeline;
    if (formats.length === 0) {
      this.said.textContent = sentence;
      return;
    }
    const {frame} = this.viewer.picture;
    const number = (key, value, name) => {
      const input = make('input', {type: 'number', value, 'aria-label': name, ...limits[key],
        onchange: () => this.check(key)});
      this.numbers[key] = {input, name, last: String(value)};
      return input;
    };
    this.numbers = {};
    const width = number('width', frame?.width ?? 800, 'Width of the film in pixels');
    const height = number('height', frame?.height ?? 600, 'Height of the film in pixels');
    const tolerance = number('tolerance', shortNumber(frame?.tolerance ?? 1 / 512),
      'Tolerance of the film');
    this.format = choice(formats[0], formats.map((one) => [one, formatNames[one]]),
      'Format of the film', () => {});
    this.start = button('Save', () => this.save(), {'aria-label': 'Begin to save the film'});
    this.start.disabled = this.state !== 'none';
    replaceKeepingFocus(this.form, labelled('Size', width), labelled('×', height),
      labelled('Tolerance', tolerance), this.format, this.start);
    if (!formats.includes('webm') && this.said.textContent === '') {
      this.said.textContent = 'Videos need the program ffmpeg, which was not found.';
    }
    this.isBuilt = true;
  }

  /** Puts the last number back where one is not within its limits, and says so. */
  check(key) {
    const one = this.numbers[key];
    const {min, max, step} = limits[key];
    const number = Number(one.input.value);
    if (one.input.value !== '' && number >= min && number <= max) {
      one.last = step === 1 ? String(Math.round(number)) : one.input.value;
      this.said.textContent = '';
    } else {
      this.said.textContent = `${one.name}: give a number from ${min} to ${max}.`;
    }
    one.input.value = one.last;
  }

  save() {
    const {connection} = this.viewer;
    if (!connection.isOpen()) return this.end('No film can be saved before the program answers.');
    this.isCancelled = false;
    this.begin('asked');
    this.bar.removeAttribute('value');
    this.text.textContent = 'The film begins…';
    const number = (key) => Number(this.numbers[key].last);
    connection.send({type: 'save_film', width: number('width'),
      height: number('height'), tolerance: number('tolerance'), format: this.format.value});
  }

  cancel() {
    // A film that has not begun is cancelled when it does.
    this.isCancelled = this.state === 'asked';
    this.viewer.connection.send({type: 'cancel_film'});
  }

  begin(state) {
    this.state = state;
    this.said.textContent = '';
    this.way.hidden = false;
    if (this.start) this.start.disabled = true;
  }

  showProgress({frame, frames, share, seconds_left: left}) {
    // The film of another page, or one that went on while this page was away, is shown once.
    const isNews = this.state === 'none';
    if (this.state !== 'going') this.begin('going');
    if (this.isCancelled) this.cancel();
    this.bar.value = Math.min((frame - 1 + share) / frames, 1);
    this.text.textContent = frame > frames ? 'Making the file…'
      : `Frame ${frame} of ${frames}${left >= 0 ? `, ${durationText(left)} left` : ''}`;
    if (isNews) this.show();
  }

  show() {
    this.element.hidden = false;
    if (this.viewer.line.isOpen) this.viewer.line.update();
    else this.viewer.line.open(true);
  }

  /** @param {string} failure empty: none @param {number} page that gets the file */
  ended(failure, page) {
    const isNews = this.state === 'none';
    if (failure) this.viewer.showMessage(failure);
    this.end(failure || (page === this.viewer.connection.page ? 'The film is saved.'
      : 'The film is saved. Another page has its file.'));
    if (isNews && !failure) this.show();
  }

  /** @param {string} text that says how it ended */
  end(text) {
    const hadFocus = this.way.contains(document.activeElement);
    this.state = 'none';
    if (this.start) this.start.disabled = false;
    this.way.hidden = true;
    this.said.textContent = text;
    if (hadFocus) this.start?.focus();
  }
}
