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

/** Asks for size, tolerance and format of a film, and tells how far it is. */
export class FilmSaver {
  /** @param {import('./main.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.bar = make('progress', {max: 1, value: 0, 'aria-label': 'Part of the film that is done'});
    this.text = make('span', {role: 'status'});
    this.form = make('div', {class: 'row'});
    this.way = make('div', {class: 'row', hidden: true}, this.bar, this.text,
      button('Cancel the film', () => viewer.connection.send({type: 'cancel_film'})));
    this.said = make('p', {class: 'hint', role: 'status'});
    this.element = make('div', {id: 'film-saver', class: 'list', role: 'group',
      'aria-label': 'Save the film', hidden: true}, this.form, this.way, this.said);
    const {connection} = viewer;
    connection.on('film_progress', (progress) => this.showProgress(progress));
    connection.on('film_ended', ({failure}) => this.end(failure));
    connection.on('error', () => { if (this.isAsked) this.end(''); });
    connection.on('lost', () => this.end(''));
  }

  toggle() {
    this.element.hidden = !this.element.hidden;
    this.update();
    if (!this.element.hidden) this.form.querySelector('input')?.focus();
  }

  update() {
    const {formats} = this.viewer.timeline;
    if (this.element.hidden || this.isBuilt) return;
    if (formats.length === 0) {
      this.said.textContent = sentence;
      return;
    }
    const {frame} = this.viewer.picture;
    const number = (value, name, limits) => make('input',
      {type: 'number', value, 'aria-label': name, ...limits});
    const edge = {min: 1, max: 8192, step: 1};
    this.width = number(frame?.width ?? 800, 'Width of the film in pixels', edge);
    this.height = number(frame?.height ?? 600, 'Height of the film in pixels', edge);
    this.tolerance = number(shortNumber(frame?.tolerance ?? 1 / 512), 'Tolerance of the film',
      {min: 0, max: 1, step: 'any'});
    this.format = choice(formats[0], formats.map((one) => [one, formatNames[one]]),
      'Format of the film', () => {});
    this.start = button('Save', () => this.save(), {'aria-label': 'Begin to save the film'});
    replaceKeepingFocus(this.form, labelled('Size', this.width), labelled('×', this.height),
      labelled('Tolerance', this.tolerance), this.format, this.start);
    if (!formats.includes('webm')) {
      this.said.textContent = 'Videos need the program ffmpeg, which was not found.';
    }
    this.isBuilt = true;
  }

  save() {
    this.isAsked = true;
    this.said.textContent = '';
    this.start.disabled = true;
    this.viewer.connection.send({type: 'save_film', width: Math.round(Number(this.width.value)),
      height: Math.round(Number(this.height.value)), tolerance: Number(this.tolerance.value),
      format: this.format.value});
  }

  showProgress({frame, frames, share, seconds_left: left}) {
    this.isAsked = false;
    this.element.hidden = this.way.hidden = false;
    this.update();
    this.start.disabled = true;
    this.bar.value = Math.min((frame - 1 + share) / frames, 1);
    this.text.textContent = frame > frames ? 'Making the file…'
      : `Frame ${frame} of ${frames}${left >= 0 ? `, ${durationText(left)} left` : ''}`;
  }

  end(failure) {
    this.isAsked = false;
    if (this.start) this.start.disabled = false;
    if (this.way.hidden) return;
    this.way.hidden = true;
    this.said.textContent = failure ? failure : 'The film is saved.';
    if (failure) this.viewer.showMessage(failure);
  }
}
