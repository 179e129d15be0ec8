// SPDX-License-Identifier: Apache-2.0
// Live pictures that WebGL renders from LF images and lens weights of the server.

import { readHead } from "../../data/head";
import type { LivePicture } from "../../data/live_picture";
import { getBytes, postForBytes } from "../../data/source";
import type { LocalPictures } from "../chosen_pictures";
import type { PathFacts } from "../one_frame_path";
import { bodyOf, type PictureRequest } from "../pictures";
import { GlRenderer } from "./gl_renderer";
import { readLens, type LensAnswer } from "./lens";
import type { LfImage } from "./lf_textures";
import { matrixOf, type LfCamera } from "./ray_forms";
import { isSoftware } from "./software";

const AT_A_TIME = 4; // LF images that are requested at the same time
const NEWS_MS = 300; // shortest time between two reports that LF images were loaded
const MOST_IMAGES = 4096; // largest number of LF images of a picture as long as their size is not known

export class GlPictures implements LocalPictures {
  private divisor = 0; // factor by which the LF images on the graphics card are shrunken
  private most = MOST_IMAGES;
  private wanted: number[] = [];
  private isLoading = false;
  private readonly absent = new Set<number>(); // LF images requested since the last lens, which are not requested again

  //   loaded  is called when LF images have come to the graphics card
  constructor(
    readonly renderer: GlRenderer,
    private readonly path: () => PathFacts,
    private readonly loaded: () => void,
  ) {}

  get name(): string {
    return this.renderer.name;
  }

  get isSoftware(): boolean {
    return isSoftware(this.name);
  }

  close(): void {
    this.wanted = [];
    this.renderer.close();
  }

  // Returns null as long as LF images of the picture are not on the graphics card; they are loaded from then on. Throws
  // if no picture of this light field can be rendered here.
  async ask(request: PictureRequest): Promise<LivePicture | null> {
    const body = { ...bodyOf(request, this.path()), images: this.most };
    const answer = await postForBytes<unknown>("lens", body);
    return answer instanceof ArrayBuffer ? this.pictureOf(request, readLens(answer)) : null;
  }

  private pictureOf({ camera }: PictureRequest, { lens, facts, refused }: LensAnswer): LivePicture | null {
    if (refused) throw new Error(refused);
    const { images } = this.renderer;
    if (facts.divisor !== this.divisor) {
      images.clear();
      this.divisor = facts.divisor;
      this.most = MOST_IMAGES;
    }
    this.wanted = lens.images.map(({ id }) => id);
    this.absent.clear();
    if (this.wanted.some((id) => !images.find(id))) {
      void this.load();
      return null;
    }
    const begin = performance.now();
    const picture = this.renderer.render(camera, lens);
    return { facts: { ...facts, render_ms: performance.now() - begin }, picture, by: "webgl" };
  }

  private next(): number | undefined {
    return this.wanted.find((id) => !this.renderer.images.find(id) && !this.absent.has(id));
  }

  private async load(): Promise<void> {
    if (this.isLoading) return;
    this.isLoading = true;
    let told_ms = performance.now();
    const loader = async () => {
      for (let id = this.next(); id !== undefined; id = this.next()) {
        this.absent.add(id); // so that no other loader requests it
        await this.loadOne(id);
        if (performance.now() - told_ms > NEWS_MS) {
          told_ms = performance.now();
          this.loaded();
        }
      }
    };
    await Promise.all(Array.from({ length: AT_A_TIME }, loader));
    this.isLoading = false;
    this.loaded();
  }

  private async loadOne(id: number): Promise<void> {
    const { divisor } = this;
    try {
      const image = readLfImage(await getBytes(`live/${divisor}/${id}.bin`));
      if (divisor !== this.divisor) return;
      const { images } = this.renderer;
      this.most = images.capacity(image);
      images.add(id, image, new Set(this.wanted));
    } catch {
      // If the server has forgotten the LF image, the next lens does not contain it.
    }
  }
}

function readLfImage(bytes: ArrayBuffer): LfImage {
  const [head, begin] = readHead<{ width: number; height: number; matrix: number[]; centre: LfCamera["centre"] }>(
    bytes,
  );
  const { width, height, matrix, centre } = head;
  const pixels = new Uint16Array(bytes, begin, 4 * width * height);
  return { width, height, matrix: matrixOf(matrix), centre, pixels };
}
