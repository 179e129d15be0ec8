// SPDX-License-Identifier: Apache-2.0
// Tells whether WebGL draws by the processor instead of a graphics card.

const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render|microsoft basic|lavapipe|swrast/i;

export function isSoftware(renderer: string): boolean {
  return SOFTWARE.test(renderer);
}

// Returns the name of the graphics card and its driver. A browser may hide it.
export function rendererName(gl: WebGL2RenderingContext): string {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}
