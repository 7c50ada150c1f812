// SPDX-License-Identifier: Apache-2.0
import {button, download, labelledAfter, make} from './elements.js';
import {embeddedFiles, isProgram} from './end.js';
import {labelledPicture} from './labelled_picture.js';
import {sizeText} from './open_panel.js';

const commandLine = 'pellucid render scene.json -o picture.png';
const pythonLines = `import pellucid
scene = pellucid.load_scene("scene.json")
pellucid.render(scene).save("picture.png")`;

/** Files to save, and the lines that make the same picture from the scene. */
export class SavePanel {
  /** @param {import('./main.js').Viewer} viewer */
  constructor(viewer) {
    const {connection} = viewer;
    const save = (what) => () => connection.send({type: 'save', what});
    const copy = (text, name) => button('Copy', () => navigator.clipboard.writeText(text),
      {'aria-label': `Copy ${name}`});
    const withMarks = make('input', {type: 'checkbox'});
    const withBar = make('input', {type: 'checkbox'});
    const savePicture = () => save(withBar.checked ? 'png_with_color_bar' : 'png')();
    // A page has neither OpenEXR nor what draws color bars.
    const ofProgram = (...parts) => (isProgram ? parts : []);
    const data = embeddedFiles().filter(({name}) => name !== 'scene.json');
    document.querySelector('#save-panel .content').append(
      make('div', {class: 'row'}, button('Picture, PNG', savePicture),
        ...ofProgram(button('Numbers, EXR', save('exr'))), button('Scene, JSON', save('scene')),
        ...data.map(({name, size, bytes}) => button(`Data, ${name} (${sizeText(size)})`,
          () => download(new Blob([bytes()], {type: 'application/zip'}), name)))),
      make('div', {class: 'row'}, labelledAfter(withMarks, 'Axes and scale bar in the PNG'),
        ...ofProgram(labelledAfter(withBar, 'Color bar in the PNG'))),
      make('p', {class: 'hint'}, 'The picture is saved exact, at the size of the window.',
        ...ofProgram(' The EXR has depth and error too.')),
      make('p', {class: 'hint'}, isProgram
        ? 'With scene.json, the same picture to the bit from a terminal:'
        : 'With scene.json and the data beside it, the same picture from a terminal, ' +
          'within the tolerance (the data are archives of NumPy):'),
      make('pre', {}, commandLine), copy(commandLine, 'the command'),
      make('p', {class: 'hint'}, 'and from Python:'),
      make('pre', {}, pythonLines), copy(pythonLines, 'the lines of Python'));
    connection.on('file', async ({name, content_type: type, bytes}) => {
      const {frame, scale} = viewer.picture;
      const isMarked = type === 'image/png' && withMarks.checked && frame;
      const blob = isMarked
        ? await labelledPicture(bytes, frame, scale) : new Blob([bytes], {type});
      download(blob, name);
    });
  }
}
