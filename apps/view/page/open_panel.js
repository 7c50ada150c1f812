// SPDX-License-Identifier: Apache-2.0
import {button, labelledAfter, make, replaceKeepingFocus} from './elements.js';
import {droppedFiles, mainFile, sendFiles} from './dropped_files.js';
import {isProgram} from './end.js';

const examples = ['sphere', 'shells', 'hydrogen', 'marschner_lobb'];

/** "3.2 MB" */
export function sizeText(bytes) {
  const units = ['bytes', 'kB', 'MB', 'GB', 'TB'];
  let unit = 0;
  for (; bytes >= 1000 && unit + 1 < units.length; ++unit) bytes /= 1000;
  return `${unit > 0 && bytes < 10 ? bytes.toFixed(1) : Math.round(bytes)} ${units[unit]}`;
}

/** Asks for a file: dropped on the page, or chosen from the folders of the program's machine. */
export class OpenPanel {
  /** @param {import('./main.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.element = document.getElementById('open-panel');
    this.button = document.getElementById('open');
    this.folder = null;
    this.progress = '';
    const {connection} = viewer;
    connection.on('start', (start) => this.begin(start));
    connection.on('folder', (folder) => {
      this.folder = folder;
      this.draw();
      this.element.querySelector('.files')?.scrollTo(0, 0);
    });
    connection.on('opening', ({name}) => this.setProgress(name === null ? '' : `Reading ${name}…`));
    connection.on('opened', () => {
      document.body.dataset.scene = 'shown';
      this.setProgress('');
      this.hide();
    });
    connection.on('lost', () => {
      this.setProgress('');
      this.hide();
    });
    connection.on('error', () => this.setProgress(''));
    this.button.addEventListener('click', () => (this.element.hidden ? this.show() : this.hide()));
    this.element.addEventListener('keydown', (event) => {
      if (event.key === 'Escape') this.hide();
      event.stopPropagation();  // the page's own keys
    });
    this.addDrop();
  }

  begin({has_scene: hasScene, can_open: canOpen, can_list: canList, upload_bytes: bytes}) {
    this.canOpen = canOpen;
    this.canList = canList;
    this.mostBytes = bytes;
    this.button.hidden = !canOpen;
    document.body.dataset.scene = hasScene ? 'shown' : 'none';
    if (!hasScene) this.show();
  }

  show() {
    this.element.hidden = false;
    this.button.setAttribute('aria-pressed', 'true');
    if (this.canList) {
      this.viewer.connection.send({type: 'list_folder', folder: this.folder?.path ?? ''});
    }
    this.draw();
    this.element.querySelector('input, button')?.focus({preventScroll: true});
  }
  hide() {
    if (document.body.dataset.scene === 'none') return;
    this.element.hidden = true;
    this.button.setAttribute('aria-pressed', 'false');
  }

  setProgress(text) {
    this.progress = text;
    this.viewer.setBusy(text);
    const line = this.element.querySelector('.progress');
    if (line) line.textContent = text;
  }

  open(input) {
    this.viewer.clearMessage();
    this.viewer.connection.send({type: 'open', input});
  }

  draw() {
    if (this.element.hidden) return;
    const path = make('input', {type: 'text', 'aria-label': 'Path of a file', spellcheck: 'false',
      placeholder: 'Path of a file, or builtin:NAME',
      onkeydown: (event) => { if (event.key === 'Enter' && path.value) this.open(path.value); }});
    path.value = this.element.querySelector('input[type="text"]')?.value ?? '';
    const files = make('input', {type: 'file', multiple: true, hidden: true,
      onchange: () => this.take([...files.files].map((file) => ({name: file.name, file})))});
    replaceKeepingFocus(this.element,
      make('h2', {}, 'Open a volume, a mesh or a scene'),
      make('p', {class: 'drop'}, 'Drop a file, files that belong together, or a folder here, or ',
        button('choose files…', () => files.click()), files,
        make('span', {class: 'hint'}, isProgram
          ? ` They are copied, up to ${sizeText(this.mostBytes)}, to a ` +
            'temporary folder that goes with the program.'
          : ` They stay in this page, up to ${sizeText(this.mostBytes)}: nothing is sent ` +
            'anywhere. It reads NIfTI, NumPy, MRC, DICOM that is not compressed, and raw scenes.')),
      make('p', {class: 'progress', role: 'status'}, this.progress),
      ...(this.canList ? [
        make('h3', {}, 'From the folders of the machine that the program runs on'),
        make('div', {class: 'row'}, path,
          button('Open', () => { if (path.value) this.open(path.value); })),
        ...this.folderParts()] : []),
      make('div', {class: 'row'}, 'Or an example: ',
        ...examples.map((name) => button(name.replace('_', '–'),
          () => this.open(`builtin:${name}`)))));
  }

  folderParts() {
    const {folder} = this;
    if (!folder) return [make('p', {class: 'hint'}, 'Reading the folder…')];
    const list = (path) => this.viewer.connection.send({type: 'list_folder', folder: path});
    const inside = (name) => `${folder.path.replace(/\/$/, '')}/${name}`;
    const filter = make('input', {type: 'checkbox', checked: this.showsAll ?? false,
      onchange: () => {
        this.showsAll = filter.checked;
        this.draw();
      }});
    const shown = folder.entries.filter((entry) => entry.folder || entry.known || this.showsAll);
    const rows = shown.map((entry) => {
      const isFolder = entry.folder && !entry.known;
      return button(isFolder ? `${entry.name}/` : entry.name,
        () => (isFolder ? list(inside(entry.name)) : this.open(inside(entry.name))),
        {class: isFolder ? 'folder' : 'file',
          'data-size': entry.bytes === undefined ? '' : sizeText(entry.bytes)});
    });
    const leftOut = folder.left_out > 0 ? `${folder.left_out} more are not listed. ` : '';
    return [
      make('div', {class: 'row'},
        button('Up', () => list(folder.parent), {disabled: folder.parent === null,
          'aria-label': 'The folder above'}),
        button('Home', () => list(folder.home), {disabled: folder.home === null}),
        make('span', {class: 'path', title: folder.path}, folder.path)),
      make('div', {class: 'files', role: 'group', 'aria-label': 'Files'},
        ...rows, rows.length === 0 ? make('p', {class: 'empty'}, 'No file of a known name.') : ''),
      make('div', {class: 'row'}, labelledAfter(filter, 'Show all files'),
        button('Open this folder', () => this.open(folder.path),
          {title: 'A series of DICOM, a stack of images, a store of Zarr'}),
        make('span', {class: 'hint'}, leftOut))];
  }

  addDrop() {
    const isFiles = (event) => this.canOpen && event.dataTransfer?.types.includes('Files');
    addEventListener('dragover', (event) => {
      if (!isFiles(event)) return;
      event.preventDefault();
      document.body.classList.add('dropping');
    });
    addEventListener('dragleave', (event) => {
      if (event.relatedTarget === null) document.body.classList.remove('dropping');
    });
    addEventListener('drop', async (event) => {
      document.body.classList.remove('dropping');
      if (!isFiles(event)) return;
      event.preventDefault();
      this.take(await droppedFiles(event.dataTransfer));
    });
  }

  /** Copies files to the program, and opens them. @param {{name: string, file: File}[]} files */
  async take(files) {
    if (files.length === 0) return;
    this.viewer.clearMessage();
    const bytes = files.reduce((sum, {file}) => sum + file.size, 0);
    if (bytes > this.mostBytes) {
      this.viewer.showMessage(`${sizeText(bytes)} are more than the ${sizeText(this.mostBytes)} ` +
        `that are copied. ${isProgram
          ? 'Choose the file from the folders of the machine instead.' : 'Take the program.'}`);
      return;
    }
    const set = Math.floor(Math.random() * 2 ** 30);
    try {
      await sendFiles(set, files, (done) =>
        this.setProgress(`Copying ${sizeText(done)} of ${sizeText(bytes)}…`));
      this.viewer.connection.send({type: 'open_upload', set, name: mainFile(files)});
    } catch (error) {
      this.setProgress('');
      this.viewer.showMessage(error.message);
    }
  }
}
