// SPDX-License-Identifier: Apache-2.0
// The LF images on the graphics card: layers of array textures, whose memory is limited.

import type { LfCamera } from "./ray_forms";
import { IMAGES_PER_DRAW } from "./shaders";

export interface LfImage extends LfCamera {
  pixels: Uint16Array; // [height][width][4]: R, G, B in linear light, and 1, or 0 if the pixel is masked
}

const BYTES_PER_PIXEL = 8;

// An array texture with LF images of one size. A draw reads the LF images of one page.
interface Page {
  texture: WebGLTexture;
  width: number;
  height: number;
  ids: (number | null)[]; // id of the LF image in each layer; null if the layer is free
}

export interface Placed extends LfCamera {
  page: Page;
  layer: number;
}

export class LfTextures {
  private readonly pages: Page[] = [];
  private readonly placed = new Map<number, Placed>();
  private bytes = 0;

  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly mostBytes: number,
  ) {}

  find(id: number): Placed | undefined {
    return this.placed.get(id);
  }

  // Returns the number of LF images of this size for which there is room.
  capacity({ width, height }: { width: number; height: number }): number {
    return Math.max(1, Math.floor(this.mostBytes / (width * height * BYTES_PER_PIXEL)));
  }

  // Adds an LF image. Forgets others if there is no room for it, but none of `kept`. Returns false if there is no room.
  add(id: number, image: LfImage, kept: ReadonlySet<number>): boolean {
    const page = this.freePage(image, kept);
    if (!page) return false;
    const layer = page.ids.indexOf(null);
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, page.texture);
    const { width, height, matrix, centre, pixels } = image;
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, layer, width, height, 1, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT, pixels);
    page.ids[layer] = id;
    this.placed.set(id, { width, height, matrix, centre, page, layer });
    return true;
  }

  clear(): void {
    for (const page of this.pages) this.gl.deleteTexture(page.texture);
    this.pages.length = 0;
    this.placed.clear();
    this.bytes = 0;
  }

  private freePage(size: { width: number; height: number }, kept: ReadonlySet<number>): Page | null {
    const { width, height } = size;
    const fits = (page: Page) => page.width === width && page.height === height;
    const free = this.pages.find((page) => fits(page) && page.ids.includes(null));
    if (free) return free;
    if (this.bytes < this.mostBytes) return this.newPage(width, height);
    for (const page of this.pages.filter(fits))
      for (const [layer, id] of page.ids.entries())
        if (id !== null && !kept.has(id)) {
          this.placed.delete(id);
          page.ids[layer] = null;
          return page;
        }
    return null;
  }

  private newPage(width: number, height: number): Page {
    const { gl } = this;
    const layerBytes = width * height * BYTES_PER_PIXEL;
    const room = Math.floor((this.mostBytes - this.bytes) / layerBytes);
    const layers = Math.max(1, Math.min(IMAGES_PER_DRAW, room));
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA16UI, width, height, layers);
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    const page: Page = { texture, width, height, ids: Array<number | null>(layers).fill(null) };
    this.bytes += layers * layerBytes;
    this.pages.push(page);
    return page;
  }
}
