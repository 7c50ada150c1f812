// SPDX-License-Identifier: Apache-2.0

/**
 * Makes an element.
 * @param {string} name of the tag
 * @param {Object<string, *>} properties attributes; "on…" adds a listener; null leaves it out
 * @param {...(Node|string)} children
 * @returns {HTMLElement}
 */
export function make(name, properties = {}, ...children) {
  return fill(document.createElement(name), properties, children);
}

/** The same for SVG. @returns {SVGElement} */
export function makeSvg(name, properties = {}, ...children) {
  return fill(document.createElementNS('http://www.w3.org/2000/svg', name), properties, children);
}

function fill(element, properties, children) {
  for (const [key, value] of Object.entries(properties)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value);
    else if (key === 'value') element.value = value;
    else if (key === 'checked') element.checked = value;
    else element.setAttribute(key, value === true ? '' : value);
  }
  element.append(...children);
  return element;
}

/** A button. */
export function button(text, onclick, properties = {}) {
  return make('button', {type: 'button', onclick, ...properties}, text);
}

/** Has the browser save data as a file. */
export function download(blob, name) {
  const address = URL.createObjectURL(blob);
  make('a', {href: address, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/** An input with its label before it. */
export function labelled(text, input, className = 'inline') {
  return make('label', {class: className}, text, input);
}

/** A check box with its label behind it. */
export function labelledAfter(input, text) {
  return make('label', {class: 'inline'}, input, text);
}

/**
 * A number to edit; `change` is called when it is complete. Where it is none, or not within the
 * limits, the number before it stays, and `refused` is told in a sentence, if it is given.
 */
export function numberInput(value, name, change, properties = {}, refused = null) {
  const {min = -Infinity, max = Infinity} = properties;
  return make('input', {type: 'number', step: 'any', value: shortNumber(value), 'aria-label': name,
    onchange: (event) => {
      const number = Number(event.target.value);
      const isNumber = event.target.value !== '' && Number.isFinite(number);
      if (isNumber && (!refused || (number >= min && number <= max))) return change(number);
      if (!refused) return;
      event.target.value = shortNumber(value);
      refused(`${name}: give a number from ${min} to ${max}.`);
    }, ...properties});
}

let active = false;

/** Whether a slider or a picker of colors is being moved; it must not be replaced meanwhile. */
export function gestureIsActive() {
  return active;
}

function setActive(now) {
  active = now;
  if (!now) window.dispatchEvent(new Event('gestureend'));
}

/** Replaces the children; the focus goes to the element of the same name as before. */
export function replaceKeepingFocus(container, ...children) {
  const focus = container.contains(document.activeElement) ? document.activeElement : null;
  const nameOf = (element) => element.getAttribute('aria-label') ?? element.textContent;
  const name = focus && nameOf(focus);
  container.replaceChildren(...children);
  if (!focus || focus.isConnected && document.activeElement === focus) return;
  const same = [...container.querySelectorAll('button, input, select, [tabindex]')]
    .find((element) => element === focus || nameOf(element) === name);
  same?.focus();
}

/** A slider; `change` is called with each value, and a gesture that lasts as long as the drag. */
export function slider(value, least, most, name, change) {
  let gesture = null;
  return make('input', {type: 'range', min: least, max: most, step: (most - least) / 200 || 1,
    value, 'aria-label': name,
    oninput: (event) => {
      gesture ??= newGesture();
      setActive(true);
      change(Number(event.target.value), gesture);
    },
    onchange: () => {
      gesture = null;
      setActive(false);
    }});
}

/** A choice of texts. */
export function choice(value, options, name, change) {
  const select = make('select', {'aria-label': name,
    onchange: (event) => change(event.target.value)});
  for (const [key, text] of options) select.append(make('option', {value: key}, text));
  select.value = value;
  return select;
}

/** A color of linear light; `change` is called with "#rrggbb". */
export function colorInput(linear, name, change) {
  let gesture = null;
  return make('input', {type: 'color', value: hexOf(linear), 'aria-label': name,
    oninput: (event) => {
      gesture ??= newGesture();
      setActive(true);
      change(event.target.value, gesture);
    },
    onchange: () => {
      gesture = null;
      setActive(false);
    }});
}

/** @param {string|number[]} color "#rrggbb" or linear light @returns {string} of CSS */
export function cssColor(color) {
  return typeof color === 'string' ? color : `color(srgb-linear ${color.join(' ')})`;
}

const sample = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});

/** @returns {string} "#rrggbb", as the browser shows the color */
export function hexOf(color) {
  if (typeof color === 'string') return color;
  sample.fillStyle = cssColor(color);
  sample.fillRect(0, 0, 1, 1);
  const [r, g, b] = sample.getImageData(0, 0, 1, 1).data;
  return '#' + [r, g, b].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

let gestures = Math.floor(Math.random() * 2 ** 29);

/** A number that edits of one drag share, so that they are undone together. */
export function newGesture() {
  return ++gestures;
}

/** Four digits, without zeros at the end. */
export function shortNumber(value) {
  return String(Number(Number(value).toPrecision(4)));
}

/** A name of CSS as it is in the current colors. */
export function themeColor(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Follows a drag from its pointerdown on. `move` and `end` get the events. */
export function followDrag(event, move, end = () => {}) {
  const target = event.currentTarget;
  target.setPointerCapture(event.pointerId);
  const moved = (next) => { if (next.pointerId === event.pointerId) move(next); };
  const ended = (next) => {
    if (next.pointerId !== event.pointerId) return;
    for (const name of ['pointerup', 'pointercancel']) target.removeEventListener(name, ended);
    target.removeEventListener('pointermove', moved);
    end(next);
  };
  target.addEventListener('pointermove', moved);
  for (const name of ['pointerup', 'pointercancel']) target.addEventListener(name, ended);
}
