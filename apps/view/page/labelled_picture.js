// SPDX-License-Identifier: Apache-2.0
import {axisMarks, scaleMark} from './overlay.js';

/**
 * Draws the axes and the scale bar on a picture that the program saved.
 * @param {Uint8ClampedArray} bytes of a PNG
 * @param {Object} frame a message "frame" of the same picture
 * @param {number} scale CSS pixels of a pixel of the picture
 * @returns {Promise<Blob>} a PNG
 */
export async function labelledPicture(bytes, frame, scale) {
  const picture = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));
  const canvas = new OffscreenCanvas(picture.width, picture.height);
  const context = canvas.getContext('2d');
  context.drawImage(picture, 0, 0);
  // As large as on the page, also where its pixels are smaller.
  context.scale(1 / scale, 1 / scale);
  const width = picture.width * scale, height = picture.height * scale;
  const marks = [axisMarks(frame.overlay.axes, height), scaleMark(frame.overlay, width, height)];
  context.lineJoin = 'round';
  context.textAlign = 'center';
  context.font = '13px system-ui, "Inter", "Segoe UI", "DejaVu Sans", sans-serif';
  for (const {x1, y1, x2, y2, color} of marks.flatMap(({lines}) => lines)) {
    for (const [stroke, thickness] of [['#000000', 4], [color, 1.5]]) {
      context.beginPath();
      context.moveTo(x1, y1);
      context.lineTo(x2, y2);
      context.strokeStyle = stroke;
      context.lineWidth = thickness;
      context.stroke();
    }
  }
  for (const {x, y, text, color} of marks.flatMap(({texts}) => texts)) {
    context.lineWidth = 3;
    context.strokeStyle = '#000000';
    context.strokeText(text, x, y);
    context.fillStyle = color;
    context.fillText(text, x, y);
  }
  return canvas.convertToBlob({type: 'image/png'});
}
