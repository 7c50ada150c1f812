// SPDX-License-Identifier: Apache-2.0

/** Plays positions one after the other, each as soon as a picture of the one before it is there. */
export class Player {
  /**
   * @param {import('./connection.js').Connection} connection
   * @param {Object} settings
   * @param {function(): number} settings.position where it stands
   * @param {function(): number} settings.count of positions; behind the last follows the first
   * @param {function(): number} settings.rate most positions in a second
   * @param {boolean} settings.skips whether it leaves out positions to keep that rate
   * @param {function(number): void} settings.show a position
   * @param {function(boolean): void} settings.changed called when it begins and when it ends
   */
  constructor(connection, settings) {
    this.connection = connection;
    Object.assign(this, settings);
    this.isPlaying = false;
    connection.on('frame', () => this.next());
    connection.on('error', () => this.stop());
    connection.on('lost', () => this.stop());
  }

  toggle() {
    if (this.isPlaying) this.stop();
    else this.start();
  }

  start() {
    if (this.isPlaying || this.count() < 2) return;
    this.isPlaying = true;
    this.first = this.at = this.position();
    this.began = this.shown = performance.now();
    this.changed(true);
    this.advance();
  }

  stop() {
    if (!this.isPlaying) return;
    this.isPlaying = false;
    clearTimeout(this.timer);
    this.changed(false);
  }

  /** Shows the next position if the picture is that of the last one. */
  next() {
    if (!this.isPlaying || this.connection.isAhead()) return;
    clearTimeout(this.timer);
    const due = this.shown + 1000 / this.rate();
    this.timer = setTimeout(() => this.advance(), Math.max(0, due - performance.now()));
  }

  advance() {
    const now = performance.now();
    const steps = this.skips
      ? Math.max(Math.floor((now - this.began) / 1000 * this.rate()) - (this.at - this.first), 1) : 1;
    this.at += steps;
    this.shown = now;
    this.show(this.at % this.count());
  }
}
