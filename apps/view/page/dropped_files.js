// SPDX-License-Identifier: Apache-2.0
import {sendFile} from './end.js';

/** Files that name the others that belong to them. */
const headers = /\.(nhdr|mhd|hdr|ifo|dat|pvt[iprsu]|vtm|vvd|ivf|json)$/i;

/** All files of a dropped folder. @returns {Promise<{name: string, file: File}[]>} */
async function filesOf(entry, path) {
  const name = path + entry.name;
  if (entry.isFile) {
    const file = await new Promise((resolve, reject) => { entry.file(resolve, reject); });
    return [{name, file}];
  }
  const reader = entry.createReader();
  const files = [];
  for (;;) {
    // A reader gives some hundred at a time.
    const entries =
      await new Promise((resolve, reject) => { reader.readEntries(resolve, reject); });
    if (entries.length === 0) return files;
    for (const one of entries) files.push(...await filesOf(one, `${name}/`));
  }
}

/** @param {DataTransfer} transfer @returns {Promise<{name: string, file: File}[]>} */
export async function droppedFiles(transfer) {
  // The transfer is emptied after the first await.
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (entries.length === 0) return [...transfer.files].map((file) => ({name: file.name, file}));
  const files = [];
  for (const entry of entries) files.push(...await filesOf(entry, ''));
  return files;
}

/** The name of what is opened: a file, a folder that was dropped, or all files (no name). */
export function mainFile(files) {
  if (files.length === 1) return files[0].name;
  const folders = new Set(files.map(({name}) => (name.includes('/') ? name.split('/')[0] : '')));
  const [folder] = folders;
  if (folders.size === 1 && folder !== '') return folder;
  return files.find(({name}) => headers.test(name) && !name.includes('/'))?.name ?? '';
}

/**
 * Sends files to the program, one after the other.
 * @param {number} set that they belong to
 * @param {{name: string, file: File}[]} files
 * @param {function(number): void} progress called with the bytes that are sent
 */
export async function sendFiles(set, files, progress) {
  let before = 0;
  for (const {name, file} of files) {
    await sendFile(set, name, file, (bytes) => progress(before + bytes));
    before += file.size;
  }
}
