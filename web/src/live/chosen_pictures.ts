// SPDX-License-Identifier: Apache-2.0
// Chooses who renders live pictures: WebGL if it uses a graphics card and is faster than the server, otherwise the
// server.

import type { LivePicture } from "../data/live_picture";
import type { Wish } from "./gl/wish";
import type { PictureRequest, Pictures } from "./pictures";

// Pictures that WebGL renders. ask() returns null as long as the graphics card lacks LF images, and throws if WebGL
// cannot render pictures of this light field.
export interface LocalPictures extends Pictures {
  readonly isSoftware: boolean;
  readonly name: string; // of the graphics card
  close(): void; // releases the memory of the graphics card
}

export class ChosenPictures implements Pictures {
  reason = ""; // why the server renders; "" if no renderer has been chosen yet, or if WebGL renders
  private local: LocalPictures | null = null;
  private isDecided = false; // true: `local`, or the server if it is null, renders all pictures

  //   open    opens WebGL; throws if there is none. It must call `lost` when the graphics card has lost its LF images
  //   loaded  is called when the renderer of later pictures has changed
  //   now     returns the time in milliseconds
  constructor(
    private readonly server: Pictures,
    private readonly wish: Wish,
    private readonly open: (lost: () => void) => LocalPictures,
    private readonly loaded: () => void,
    private readonly now = () => performance.now(),
  ) {}

  async ask(request: PictureRequest): Promise<LivePicture | null> {
    this.start();
    if (this.local && this.isDecided) {
      const picture = await this.askLocal(request);
      if (picture) return picture;
    }
    const begin = this.now();
    const picture = await this.server.ask(request);
    const server_ms = this.now() - begin;
    if (!this.isDecided && picture && request.budget_ms === null) await this.compare(request, server_ms);
    return picture;
  }

  // Opens WebGL at the first picture, because a page that shows none needs no memory of the graphics card.
  private start(): void {
    if (this.isDecided || this.local) return;
    if (this.wish === "server") return this.leave("the address of the page says so");
    try {
      this.local = this.open(() => this.leave("the graphics card has lost its LF images"));
    } catch (error) {
      return this.leave(messageOf(error));
    }
    if (this.wish === "webgl") this.isDecided = true;
    else if (this.local.isSoftware) this.leave(`${this.local.name} is no graphics card`);
  }

  private leave(reason: string): void {
    if (this.isDecided && !this.local) return;
    this.reason = reason;
    this.isDecided = true;
    const { local } = this;
    this.local = null;
    local?.close();
    if (local) this.loaded();
  }

  // Returns null if there is no picture by WebGL, now or at all.
  private async askLocal(request: PictureRequest): Promise<LivePicture | null> {
    try {
      return (await this.local?.ask(request)) ?? null;
    } catch (error) {
      this.leave(messageOf(error));
      return null;
    }
  }

  // Renders the still picture that the server has just rendered, and compares the times.
  private async compare(request: PictureRequest, server_ms: number): Promise<void> {
    // The first picture also compiles shaders.
    if (!(await this.askLocal(request))) return;
    const begin = this.now();
    if (!(await this.askLocal(request))) return;
    const local_ms = this.now() - begin;
    if (local_ms < server_ms) this.isDecided = true;
    else this.leave(`WebGL takes ${Math.round(local_ms)} ms, the server ${Math.round(server_ms)} ms for a picture`);
  }
}

function messageOf(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
