// SPDX-License-Identifier: Apache-2.0
import {makeSvg, shortNumber} from './elements.js';

const axisLength = 34;
const margin = 56;
const axisColors = ['#ff8a80', '#a5e887', '#8ab8ff'];

/**
 * Draws axes, scale bar, clips and the probe over a picture.
 * @param {SVGElement} svg
 * @param {Object} frame a message "frame"; its overlay says what is where
 * @param {number} scale CSS pixels of a pixel of the picture
 * @param {?{x: number, y: number}} probed
 * @param {function(number, string, PointerEvent): void} dragHandle
 */
export function drawOverlay(svg, frame, scale, probed, dragHandle) {
  const width = frame.width * scale, height = frame.height * scale;
  svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
  const {axes, clips} = frame.overlay;
  svg.replaceChildren(
    ...clips.flatMap((clip, i) => clipShapes(clip, i, width, height, dragHandle)),
    ...axisShapes(axes, margin, height - margin),
    ...scaleBar(frame.overlay, width, height));
  if (probed) {
    svg.append(makeSvg('circle', {class: 'probe', r: 5, cx: probed.x * width,
      cy: probed.y * height}));
  }
}

function axisShapes(axes, x, y) {
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
  return ends.flatMap((end) => {
    const reach = axisLength * end.length;
    const line = makeSvg('line', {x1: x, y1: y, x2: x + reach * end.x, y2: y + reach * end.y});
    line.style.stroke = end.color;
    const text = makeSvg('text', {x: x + (reach + 9) * end.x, y: y + (reach + 9) * end.y + 4.5,
      'text-anchor': 'middle'}, end.text);
    text.style.fill = end.color;
    return [line, text];
  });
}

/** As long as 1, 2 or 5 times a power of ten of the file's unit. */
function scaleBar(overlay, width, height) {
  const unitPixels = height / overlay.height;
  const longest = Math.min(160, width / 3) / unitPixels;
  const power = 10 ** Math.floor(Math.log10(longest));
  const length = [5, 2, 1].find((digit) => digit * power <= longest) * power;
  const right = width - 20, left = right - length * unitPixels, y = height - 24;
  const text = `${shortNumber(length)}${overlay.unit ? ' ' + overlay.unit : ''}`;
  return [
    makeSvg('line', {x1: left, x2: right, y1: y, y2: y}),
    makeSvg('line', {x1: left, x2: left, y1: y - 5, y2: y + 5}),
    makeSvg('line', {x1: right, x2: right, y1: y - 5, y2: y + 5}),
    makeSvg('text', {x: (left + right) / 2, y: y - 8, 'text-anchor': 'middle'}, text),
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
