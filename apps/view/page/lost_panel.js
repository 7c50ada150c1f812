// SPDX-License-Identifier: Apache-2.0
import {button, download, make} from './elements.js';
import {isProgram} from './end.js';

/** Says how to go on when the program does not answer any more, and saves what was edited. */
export class LostPanel {
  /** @param {import('./main.js').Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.element = document.getElementById('lost');
    viewer.connection.on('lost', ({reason}) => (isProgram ? this.show() : this.tell(reason)));
    viewer.connection.on('open', () => { this.element.hidden = true; });
  }

  /** Says why the page's own renderer ended. @param {string} reason */
  tell(reason) {
    const {viewer} = this;
    const actions = viewer.scene === null ? [] : [make('p', {class: 'row'},
      ...(viewer.savable ? [button('Save scene.json', () => this.save())] : []),
      button('Start again', () => viewer.connection.connect()),
      ' from the scene that the page came with.')];
    this.element.replaceChildren(make('strong', {}, reason), ...actions);
    this.element.hidden = false;
  }

  show() {
    if (!this.element.hidden) return;
    const {viewer} = this;
    const port = location.port ? ` --port ${location.port}` : '';
    const canSave = viewer.scene !== null && viewer.savable;
    const command = `pellucid view${viewer.scene ? ' scene.json' : ''}${port}`;
    const lines = [make('strong', {}, 'The program does not answer.'),
      make('span', {}, ' This page goes on by itself as soon as it does, with the edits that you ' +
        'make meanwhile. If the program has ended:')];
    if (canSave) {
      lines.push(make('p', {class: 'row'}, '1. ',
        button('Save scene.json', () => this.save()), ' It has all of your edits.'));
    } else if (viewer.scene) {
      lines.push(make('p', {}, 'Run it again: the data were arrays in its memory.'));
    }
    if (canSave || !viewer.scene) {
      lines.push(make('p', {class: 'row'}, canSave ? '2. In its folder run ' : 'Run ',
        make('code', {}, command),
        button('Copy', () => navigator.clipboard.writeText(command),
          {'aria-label': 'Copy the command'})));
    }
    if (viewer.temporary) {
      lines.push(make('p', {}, 'The data were dropped here: put them beside scene.json.'));
    }
    this.element.replaceChildren(...lines);
    this.element.hidden = false;
  }

  /** The scene as the program would save it, from what it told last. */
  save() {
    const scene = structuredClone(this.viewer.scene);
    const {frame} = this.viewer.picture;
    if (frame) {
      scene.camera = frame.camera;
      if (scene.integration) scene.integration.tolerance = frame.tolerance;
    }
    const text = `${JSON.stringify(scene, null, 2)}\n`;
    download(new Blob([text], {type: 'application/json'}), 'scene.json');
  }
}
