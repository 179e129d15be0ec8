// SPDX-License-Identifier: Apache-2.0
// Decides when a live picture is requested. While the camera changes, pictures are quick: each is requested when the
// one before has come, of the newest state. A still picture, of all LF images that are loaded, follows after a pause.

export const PAUSE_MS = 150; // time from the last change to the still picture
const LOADING_MS = 250; // shortest time between two still pictures while LF images are loaded
const MOST_DOUBLINGS = 5;

export class LiveRequests {
  private newest = 0; // number of the newest request
  private quickOnTheWay = false;
  private stillOnTheWay = false;
  private wantsQuick = false;
  private wantsStill = false;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private changed_ms = 0; // time of the last change
  private isStopped = true;
  private lost = 0; // number of still pictures, one after another, that another page superseded

  // ask   requests a picture and shows it, unless isNewest() is false when it comes. Returns false if another page has
  //       superseded the picture. Must not throw.
  constructor(private readonly ask: (isStill: boolean, isNewest: () => boolean) => Promise<boolean>) {}

  // The camera or the size of the picture has changed.
  change(): void {
    this.changed_ms = performance.now();
    this.wantsQuick = true;
    this.wantsStill = true;
    this.next();
  }

  // LF images have been loaded.
  loaded(): void {
    if (this.wantsStill) return;
    this.wantsStill = true;
    this.wait(LOADING_MS);
  }

  // Nothing is requested until start() is called.
  stop(): void {
    this.isStopped = true;
    clearTimeout(this.timer);
  }

  start(): void {
    if (!this.isStopped) return;
    this.isStopped = false;
    this.change();
  }

  private wait(time_ms: number): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.next(true), time_ms);
  }

  private next(isPauseOver = false): void {
    if (this.isStopped || this.quickOnTheWay) return;
    if (this.wantsQuick) {
      // A still picture on the way is superseded by this request.
      clearTimeout(this.timer);
      this.wantsQuick = false;
      this.quickOnTheWay = true;
      void this.send(false).then(() => {
        this.quickOnTheWay = false;
        this.next();
      });
    } else if (this.wantsStill && !this.stillOnTheWay) {
      const rest = this.changed_ms + PAUSE_MS - performance.now();
      if (!isPauseOver) return this.wait(Math.max(0, rest));
      this.wantsStill = false;
      this.stillOnTheWay = true;
      void this.send(true).then((isThere) => {
        this.stillOnTheWay = false;
        this.lost = isThere ? 0 : this.lost + 1;
        if (!isThere) this.wantsStill = true;
        // Two pages that supersede each other's pictures wait longer and longer, so that each gets one.
        const pause = LOADING_MS * 2 ** Math.min(this.lost, MOST_DOUBLINGS);
        if (this.wantsStill) this.wait(Math.max(pause, this.changed_ms + PAUSE_MS - performance.now()));
      });
    }
  }

  private send(isStill: boolean): Promise<boolean> {
    const number = ++this.newest;
    return this.ask(isStill, () => number === this.newest && !this.isStopped);
  }
}
