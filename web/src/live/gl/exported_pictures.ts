// SPDX-License-Identifier: Apache-2.0
// Live pictures of an exported page. There is no server: WebGL renders all pictures from the exported LF images, with
// lens weights that are computed here. If there is not enough time, for example without a graphics card, pictures are
// coarser or have fewer LF images (fitting.ts).

import type { LivePicture } from "../../data/live_picture";
import type { PictureRequest, Pictures } from "../pictures";
import { loadExported, type ExportedLive } from "./exported_images";
import { fitting } from "./fitting";
import { GlRenderer } from "./gl_renderer";
import { lensOf } from "./lens_shares";
import { plateOf, type LfCamera } from "./ray_forms";

const AT_A_TIME = 4; // LF images that are decoded at the same time
const NEWS_MS = 400; // shortest time between two reports that LF images were loaded
const STILL_MS = 2000; // longest time for a still picture
const NEWEST = 0.5; // weight of the newest picture in ray_ms

export class ExportedPictures implements Pictures {
  private renderer: GlRenderer | null = null;
  private readonly cameras = new Map<number, LfCamera>(); // of the loaded LF images, in the order of loading
  private asked = 0; // number of LF images whose loading has begun
  private broken = 0;
  private ray_ms = 2e-6; // running mean, over pictures, of the time for one element of one LF image
  private isFirst = true; // true: the next picture also compiles shaders, so that its time does not count

  constructor(
    private readonly live: ExportedLive,
    private readonly loaded: () => void,
  ) {}

  ask(request: PictureRequest): Promise<LivePicture> {
    return Promise.resolve(this.render(request));
  }

  private render({ camera, width, budget_ms }: PictureRequest): LivePicture {
    this.renderer ??= this.open();
    const begin = performance.now();
    const wanted = plateOf(camera, width);
    const loaded = [...this.cameras];
    const fit = fitting(loaded.length, wanted, (budget_ms ?? STILL_MS) / this.ray_ms);
    const plate = plateOf(camera, fit.width);
    const { lens, spacing, uncoveredShare } = lensOf(camera, plate, new Map(loaded.slice(0, fit.images)));
    const rendering = performance.now();
    const picture = this.renderer.render(camera, lens);
    const end = performance.now();
    const rays = lens.plate.width * lens.plate.height * lens.images.length;
    if (rays > 0 && !this.isFirst) this.ray_ms += NEWEST * ((end - rendering) / rays - this.ray_ms);
    if (rays > 0) this.isFirst = false;
    return {
      facts: {
        images: fit.images,
        takeable: loaded.length,
        used: lens.images.length,
        resident: loaded.length,
        needed: this.live.images.length,
        wanted: this.live.images.length,
        done: loaded.length + this.broken,
        broken: this.broken,
        first_broken: this.broken > 0 ? "the browser cannot decode them" : "",
        memory_bytes: 0,
        image_bytes: 0,
        divisor: this.live.divisor,
        uncovered_share: uncoveredShare,
        camera_distance: spacing,
        render_ms: end - begin,
      },
      picture,
      by: "webgl",
    };
  }

  private open(): GlRenderer {
    const renderer = GlRenderer.open(() => this.forget());
    void this.load(renderer);
    return renderer;
  }

  // Is called when the graphics card has lost the LF images. The next picture loads them again.
  private forget(): void {
    this.renderer = null;
    this.cameras.clear();
    this.asked = 0;
    this.loaded();
  }

  private async load(renderer: GlRenderer): Promise<void> {
    const { images } = this.live;
    let told_ms = performance.now();
    const loader = async () => {
      while (this.asked < images.length && renderer === this.renderer) {
        const image = images[this.asked++];
        try {
          const loaded = await loadExported(image);
          if (renderer !== this.renderer) return;
          renderer.images.add(image.id, loaded, new Set(this.cameras.keys()));
          const { width, height, matrix, centre } = loaded;
          this.cameras.set(image.id, { width, height, matrix, centre });
        } catch {
          ++this.broken;
        }
        if (performance.now() - told_ms > NEWS_MS) {
          told_ms = performance.now();
          this.loaded();
        }
      }
    };
    // Waits until render() has set `renderer`, which it does after open() returns.
    await Promise.resolve();
    await Promise.all(Array.from({ length: AT_A_TIME }, loader));
    this.loaded();
  }
}
