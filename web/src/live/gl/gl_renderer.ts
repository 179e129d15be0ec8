// SPDX-License-Identifier: Apache-2.0
// Renders live pictures by WebGL2: each element of the picture reads every LF image of the lens.

import { arcOf, squeezeOf } from "../../data/opening";
import type { FrameCamera } from "../../data/frame_camera";
import type { GrowingPicture } from "../../data/growing_picture";
import type { Lens, LensImage } from "./lens";
import { LfTextures, type Placed } from "./lf_textures";
import { pixelsPerElement, rayForms } from "./ray_forms";
import { COLLECT, DEVELOP, IMAGES_PER_DRAW, NODES_PER_ROW, TRIANGLE, VECTORS_PER_IMAGE } from "./shaders";
import { rendererName } from "./software";

const MOST_BYTES = 256 << 20; // limit of the memory for LF images on the graphics card
const RIM = 1e-6; // relative tolerance of the opening, for single precision
const FEATHER_SHARE = 1 / 32; // width of the feather, as a share of the shorter side of an LF image
const BLOCK = 8; // width of a block of elements that have the same weight, in elements

interface Target {
  texture: WebGLTexture;
  frame: WebGLFramebuffer;
}

// An LF image of the lens, where it is on the graphics card, and the index of its first weight.
interface Drawn extends LensImage {
  placed: Placed;
  node: number;
}

export class GlRenderer {
  readonly images: LfTextures;
  readonly name: string; // of the graphics card
  private readonly collect: WebGLProgram;
  private readonly develop: WebGLProgram;
  private readonly block: WebGLBuffer;
  private readonly nodes: WebGLTexture;
  private size = "";
  private sums: Target[] = [];
  private packed: Target | null = null;

  //   lost  is called when the driver has taken the memory of the graphics card away
  // Throws if the browser has no WebGL2, or cannot draw to floats.
  static open(lost: () => void, mostBytes = MOST_BYTES): GlRenderer {
    const canvas = document.createElement("canvas");
    const gl = canvas.getContext("webgl2", { antialias: false, depth: false, alpha: false });
    if (!gl) throw new Error("the browser has no WebGL2");
    if (!gl.getExtension("EXT_color_buffer_float")) throw new Error("WebGL2 cannot draw to floats here");
    canvas.addEventListener("webglcontextlost", lost);
    return new GlRenderer(gl, mostBytes);
  }

  private constructor(
    private readonly gl: WebGL2RenderingContext,
    mostBytes: number,
  ) {
    this.images = new LfTextures(gl, mostBytes);
    this.name = rendererName(gl);
    this.collect = this.program(COLLECT);
    this.develop = this.program(DEVELOP);
    this.block = gl.createBuffer();
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.block);
    gl.uniformBlockBinding(this.collect, gl.getUniformBlockIndex(this.collect, "Images"), 0);
    this.nodes = gl.createTexture();
    gl.bindVertexArray(gl.createVertexArray());
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
  }

  // Releases the memory of the graphics card.
  close(): void {
    this.gl.getExtension("WEBGL_lose_context")?.loseContext();
  }

  // Returns the picture of the lens. All its LF images must be in `images`.
  render(camera: FrameCamera, lens: Lens): GrowingPicture {
    const { gl } = this;
    const { width, height } = lens.plate;
    this.setSize(width, height);
    gl.viewport(0, 0, width, height);
    this.setLens(camera, lens);
    let [from, to] = this.sums;
    gl.bindFramebuffer(gl.FRAMEBUFFER, from.frame);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    for (const some of this.draws(lens)) {
      this.bind(0, gl.TEXTURE_2D, from.texture);
      this.bind(1, gl.TEXTURE_2D_ARRAY, some[0].placed.page.texture);
      gl.bufferData(gl.UNIFORM_BUFFER, this.vectorsOf(camera, lens, some), gl.DYNAMIC_DRAW);
      gl.uniform1i(this.place(this.collect, "count"), some.length);
      gl.bindFramebuffer(gl.FRAMEBUFFER, to.frame);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      [from, to] = [to, from];
    }
    return this.read(lens, from);
  }

  // Returns the LF images of each draw: at most IMAGES_PER_DRAW, all of the same page (LfTextures).
  private draws(lens: Lens): Drawn[][] {
    const ofPage = new Map<unknown, Drawn[]>();
    lens.images.forEach((image, i) => {
      const placed = this.images.find(image.id);
      if (!placed) throw new Error(`LF image ${image.id} is not on the graphics card`);
      const drawn = { ...image, placed, node: i * lens.columns * lens.rows };
      ofPage.set(placed.page, [...(ofPage.get(placed.page) ?? []), drawn]);
    });
    return [...ofPage.values()].flatMap((all) => {
      const parts: Drawn[][] = [];
      for (let i = 0; i < all.length; i += IMAGES_PER_DRAW) parts.push(all.slice(i, i + IMAGES_PER_DRAW));
      return parts;
    });
  }

  private vectorsOf(camera: FrameCamera, lens: Lens, images: Drawn[]): Float32Array {
    const vectors = new Float32Array(4 * IMAGES_PER_DRAW * VECTORS_PER_IMAGE);
    images.forEach(({ placed, node, shift, samples }, i) => {
      const forms = rayForms(camera, lens.plate, placed, lens.radius);
      const { width, height, layer } = placed;
      // Width of the border of the LF image in which a corner of an element's block may be feathered, in LF pixels.
      const reach = 2 * BLOCK * pixelsPerElement(forms, lens.plate);
      const border = Math.min(1e6, 1 + FEATHER_SHARE * Math.min(width, height) + reach);
      const rows = [
        [...forms.pixel[0], width],
        [...forms.pixel[1], height],
        [...forms.pixel[2], border],
        [...forms.forward, layer],
        [...forms.lensRight, shift[0] + 8 * shift[1] + 64 * samples],
        [...forms.lensUp, node],
      ];
      vectors.set(rows.flat(), 4 * VECTORS_PER_IMAGE * i);
    });
    return vectors;
  }

  private setLens(camera: FrameCamera, lens: Lens): void {
    const { gl, collect } = this;
    const { plate } = lens;
    gl.useProgram(collect);
    const at = (name: string) => this.place(collect, name);
    gl.uniform1i(at("earlier"), 0);
    gl.uniform1i(at("pixels"), 1);
    gl.uniform1i(at("nodes"), 2);
    gl.uniform2i(at("plate"), plate.width, plate.height);
    gl.uniform2i(at("grid"), lens.columns, lens.rows);
    const isRound = lens.blades < 3 || lens.roundness === 1;
    const arc = isRound || lens.roundness === 0 ? null : arcOf(Math.PI / lens.blades, lens.roundness);
    gl.uniform1i(at("blades"), isRound ? 0 : lens.blades);
    gl.uniform2f(at("squeeze"), ...squeezeOf(lens));
    gl.uniform2f(at("arc"), arc?.radius ?? 0, arc?.centre ?? 0);
    gl.uniform1f(at("rotation"), lens.rotation);
    gl.uniform1i(at("hasFeather"), lens.hasFeather ? 1 : 0);
    gl.uniform1f(at("rim"), RIM);
    // This form is the same for all LF cameras.
    const anywhere = { width: 1, height: 1, matrix: [camera.right, camera.up, camera.forward], centre: camera.centre };
    gl.uniform3fv(at("front"), rayForms(camera, plate, anywhere as Placed, lens.radius).front);
    this.setNodes(lens.nodes);
  }

  private setNodes(nodes: Uint16Array): void {
    const { gl } = this;
    const rows = Math.max(1, Math.ceil(nodes.length / NODES_PER_ROW));
    const padded = new Uint16Array(rows * NODES_PER_ROW);
    padded.set(nodes);
    this.bind(2, gl.TEXTURE_2D, this.nodes);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R16UI, NODES_PER_ROW, rows, 0, gl.RED_INTEGER, gl.UNSIGNED_SHORT, padded);
    this.useNearest();
  }

  private read(lens: Lens, sums: Target): GrowingPicture {
    const { gl, develop } = this;
    const { width, height } = lens.plate;
    const rows = Math.ceil(height / 2);
    gl.useProgram(develop);
    gl.uniform1i(this.place(develop, "sums"), 0);
    gl.uniform2i(this.place(develop, "plate"), width, height);
    gl.uniform1f(this.place(develop, "pedestal"), lens.pedestal);
    const [a, b, c, d, e, f, g, h, i] = lens.colours;
    gl.uniformMatrix3fv(this.place(develop, "colours"), false, [a, d, g, b, e, h, c, f, i]);
    this.bind(0, gl.TEXTURE_2D, sums.texture);
    gl.viewport(0, 0, width, rows);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.packed!.frame);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const packed = new Uint32Array(4 * width * rows);
    gl.readPixels(0, 0, width, rows, gl.RGBA_INTEGER, gl.UNSIGNED_INT, packed);
    if (gl.isContextLost()) throw new Error("the graphics card has forgotten the picture");
    const halves = new Uint16Array(packed.buffer, 0, 4 * width * height);
    return { width, height, fullWidth: width, fullHeight: height, hasRays: true, halves };
  }

  private setSize(width: number, height: number): void {
    const { gl } = this;
    if (this.size === `${width} ${height}`) return;
    this.size = `${width} ${height}`;
    for (const target of [...this.sums, this.packed])
      if (target) {
        gl.deleteTexture(target.texture);
        gl.deleteFramebuffer(target.frame);
      }
    this.sums = [this.target(gl.RGBA32F, width, height), this.target(gl.RGBA32F, width, height)];
    this.packed = this.target(gl.RGBA32UI, width, Math.ceil(height / 2));
  }

  private target(format: number, width: number, height: number): Target {
    const { gl } = this;
    const texture = gl.createTexture();
    this.bind(0, gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    this.useNearest();
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return { texture, frame };
  }

  private useNearest(): void {
    const { gl } = this;
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  }

  private bind(unit: number, kind: number, texture: WebGLTexture): void {
    this.gl.activeTexture(this.gl.TEXTURE0 + unit);
    this.gl.bindTexture(kind, texture);
  }

  private place(program: WebGLProgram, name: string): WebGLUniformLocation | null {
    return this.gl.getUniformLocation(program, name);
  }

  private program(fragment: string): WebGLProgram {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, text] of [
      [gl.VERTEX_SHADER, TRIANGLE],
      [gl.FRAGMENT_SHADER, fragment],
    ] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
        throw new Error(`a shader does not compile: ${gl.getShaderInfoLog(shader)}`);
    }
    gl.linkProgram(program);
    return program;
  }
}
