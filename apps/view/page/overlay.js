// SPDX-License-Identifier: Apache-2.0
import {makeSvg, shortNumber} from './elements.js';

const axisLength = 34;
const margin = 56;
export const axisColors = ['#ff8a80', '#a5e887', '#8ab8ff'];

/**
 * Draws axes, scale bar, clips and the probe over a picture.
 * @param {SVGElement} svg
 * @param {Object} frame a message "frame"; its overlay says what is where
 * @param {number} scale CSS pixels of a pixel of the picture
 * @param {?{x: number, y: number}} probed
 * @param {function(number, string, PointerEvent): void} dragHandle
 * @param {?function(number, number): SVGElement[]} marks more shapes for a width and a height
 */
export function drawOverlay(svg, frame, scale, probed, dragHandle, marks) {
  const width = frame.width * scale, height = frame.height * scale;
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  const {axes, clips} = frame.overlay;
  svg.replaceChildren(
    ...clips.flatMap((clip, i) => clipShapes(clip, i, width, height, dragHandle)),
    ...(marks?.(width, height) ?? []), ...shapesOf(axisMarks(axes, height)), ...shapesOf(scaleMark(frame.overlay, width, height)));
  if (probed) {
    svg.append(makeSvg('circle', {class: 'probe', r: 5, cx: probed.x * width,
      cy: probed.y * height}));
  }
}

/**
 * Lines and texts of the axes, the farther ones first. Letters are those of a patient where the
 * data have a patient's axes.
 * @returns {{lines: Object[], texts: Object[]}}
 */
export function axisMarks(axes, height) {
  const x = margin, y = height - margin;
  const ends = [];
  axes.forEach((axis, i) => {
    for (const [sign, text] of [[1, axis.plus], [-1, axis.minus]]) {
      if (text === '') continue;
      ends.push({x: sign * axis.x, y: sign * axis.y, z: sign * axis.z, text, color: axisColors[i],
        length: axes[0].minus === '' ? 1 : 0.8});
    }
  });
  // What is near lies over what is far.
  ends.sort((a, b) => b.z - a.z);
  return {
    lines: ends.map((end) => ({x1: x, y1: y, x2: x + axisLength * end.length * end.x,
      y2: y + axisLength * end.length * end.y, color: end.color})),
    texts: ends.map((end) => ({x: x + (axisLength * end.length + 9) * end.x,
      y: y + (axisLength * end.length + 9) * end.y + 4.5, text: end.text, color: end.color})),
  };
}

/** Lines and text of a bar as long as 1, 2 or 5 times a power of ten of the file's unit. */
export function scaleMark(overlay, width, height) {
  const unitPixels = height / overlay.height;
  const longest = Math.min(160, width / 3) / unitPixels;
  const power = 10 ** Math.floor(Math.log10(longest));
  const length = [5, 2, 1].find((digit) => digit * power <= longest) * power;
  const right = width - 20, left = right - length * unitPixels, y = height - 24;
  const color = '#ffffff';
  return {
    lines: [
      {x1: left, x2: right, y1: y, y2: y, color},
      {x1: left, x2: left, y1: y - 5, y2: y + 5, color},
      {x1: right, x2: right, y1: y - 5, y2: y + 5, color},
    ],
    texts: [{x: (left + right) / 2, y: y - 8, color,
      text: `${shortNumber(length)}${overlay.unit ? ' ' + overlay.unit : ''}`}],
  };
}

/** Shapes of the marks that axisMarks() and scaleMark() return. */
export function shapesOf({lines, texts}) {
  return [
    ...lines.map(({x1, y1, x2, y2, color}) => {
      const line = makeSvg('line', {x1, y1, x2, y2});
      line.style.stroke = color;
      return line;
    }),
    ...texts.map(({x, y, text, color}) => {
      const shape = makeSvg('text', {x, y, 'text-anchor': 'middle'}, text);
      shape.style.fill = color;
      return shape;
    }),
  ];
}

function clipShapes(clip, index, width, height, dragHandle) {
  const lines = clip.lines.map(([x1, y1, x2, y2]) => makeSvg('line', {class: 'outline',
    x1: x1 * width, y1: y1 * height, x2: x2 * width, y2: y2 * height}));
  const handles = clip.handles.map(({name, x, y}) => makeSvg('circle', {class: 'handle', r: 7,
    cx: x * width, cy: y * height, 'data-clip': index, 'data-handle': name,
    onpointerdown: (event) => dragHandle(index, name, event)}));
  return [...lines, ...handles];
}
