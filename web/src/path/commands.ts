// SPDX-License-Identifier: Apache-2.0
// Makes the shell commands that render a film. Options with default values are left out, so that people can read and
// copy the commands.

export interface LightFieldOptions {
  focalPx?: number;
  fovDeg?: number;
  images?: string;
  imageScale?: string;
  imageAlpha?: string;
  background?: string;
}

// Options that lfpreprocessor and lfrenderer share. `seed` decides the order of the LF images.
export interface SharedOptions extends LightFieldOptions {
  frames?: string;
  memory?: string;
  maxImages?: number;
  maxAngle?: number; // degrees
  lensWeights?: "auto" | "none" | "area" | "hat";
  estimator?: "auto" | "nearest" | "bilinear";
  overwrite?: boolean;
  threads?: number;
  seed?: number;
  strict?: boolean;
}

export interface PreprocessorOptions extends SharedOptions {
  packages?: number;
  framesPerPackage?: number;
  balance?: "rays" | "frames";
  order?: "shuffle" | "round-robin" | "area";
  depths?: readonly [number, number];
}

export interface RendererOptions extends SharedOptions {
  format?: "exr" | "exr-float" | "png" | "png16";
  video?: string;
  noContactSheet?: boolean;
  dumpEvery?: string;
  resume?: boolean;
  stopWhen?: string;
  require?: string;
  keepPlates?: boolean;
  smoothBelow?: number;
  mode?: "collect" | "rebin" | "hybrid";
  filter?: "auto" | "nearest" | "bilinear" | "bicubic" | "mosaic" | "prefiltered";
}

export interface PreprocessorRequest {
  lightField: string;
  pathFile: string;
  output?: string; // folder of the packages; unset: --plan, which writes nothing
  options?: PreprocessorOptions;
}

export interface RendererRequest {
  lightField: string;
  pathFile: string;
  output: string; // folder of the frames
  options?: RendererOptions;
}

export interface PackageRequest {
  packageFolder: string;
  output: string;
  options?: RendererOptions;
}

export interface FilmRequest {
  lightField: string;
  pathFile: string;
  output: string;
  packageFolder?: string;
  options?: RendererOptions & PreprocessorOptions;
}

type Value = string | number | boolean | readonly number[] | undefined;

// An option of a program. It is left out if its value is unset, "", false or `initial`.
interface Flag {
  flag: string;
  initial?: Value;
  isFile?: boolean; // true: the value is a file name (quoteFile())
}

const kLightField: Record<string, Flag> = {
  focalPx: { flag: "--focal-px", initial: 0 },
  fovDeg: { flag: "--fov-deg", initial: 0 },
  images: { flag: "--images", isFile: true },
  imageScale: { flag: "--image-scale", initial: "auto" },
  imageAlpha: { flag: "--image-alpha", initial: "auto" },
  background: { flag: "--background" },
};

const kShared: Record<string, Flag> = {
  overwrite: { flag: "--overwrite" },
  frames: { flag: "--frames" },
  memory: { flag: "--memory", initial: "8G" },
  maxImages: { flag: "--max-images", initial: 0 },
  maxAngle: { flag: "--max-angle", initial: 0 },
  lensWeights: { flag: "--lens-weights", initial: "auto" },
  estimator: { flag: "--estimator", initial: "auto" },
};

const kCommon: Record<string, Flag> = {
  threads: { flag: "--threads", initial: 0 },
  seed: { flag: "--seed", initial: 0 },
  strict: { flag: "--strict" },
};

const kPreprocessor: Record<string, Flag> = {
  ...kLightField,
  ...kShared,
  packages: { flag: "--packages", initial: 0 },
  framesPerPackage: { flag: "--frames-per-package", initial: 0 },
  balance: { flag: "--balance", initial: "rays" },
  order: { flag: "--order", initial: "shuffle" },
  depths: { flag: "--depths" },
  ...kCommon,
};

const kRenderer: Record<string, Flag> = {
  ...kLightField,
  ...kShared,
  resume: { flag: "--resume" },
  format: { flag: "--format", initial: "exr" },
  video: { flag: "--video", isFile: true },
  noContactSheet: { flag: "--no-contact-sheet" },
  dumpEvery: { flag: "--dump-every", initial: "30s" },
  stopWhen: { flag: "--stop-when" },
  require: { flag: "--require" },
  keepPlates: { flag: "--keep-plates" },
  smoothBelow: { flag: "--smooth-below", initial: 0 },
  mode: { flag: "--mode", initial: "collect" },
  filter: { flag: "--filter", initial: "auto" },
  ...kCommon,
};

// Options that are left out if packages are rendered, because the packages contain them already, and lfrenderer refuses
// some of them.
const kInPackages = [...Object.keys(kLightField), "seed", "maxImages", "maxAngle", "frames"];

export function preprocessorCommand(request: PreprocessorRequest): string {
  const target = request.output === undefined ? ["--plan"] : ["-o", quoteFile(request.output)];
  return [
    "lfpreprocessor",
    quoteFile(request.lightField),
    quoteFile(request.pathFile),
    ...target,
    ...flags(kPreprocessor, request.options ?? {}, request.output === undefined ? ["overwrite"] : []),
  ].join(" ");
}

export function rendererCommand(request: RendererRequest | PackageRequest): string {
  const isPackages = "packageFolder" in request;
  const input = isPackages
    ? [`${quoteFile(request.packageFolder.replace(/\/+$/, ""))}/package-*.lfp`]
    : [quoteFile(request.lightField), quoteFile(request.pathFile)];
  return [
    "lfrenderer",
    ...input,
    "-o",
    quoteFile(request.output),
    ...flags(kRenderer, request.options ?? {}, isPackages ? kInPackages : []),
  ].join(" ");
}

// Returns the command of lfrenderer; if request.packageFolder is set, the commands of lfpreprocessor and lfrenderer.
export function filmCommands(request: FilmRequest): string[] {
  const options = request.options ?? {};
  const folder = request.packageFolder;
  if (folder === undefined) return [rendererCommand(request)];
  return [
    preprocessorCommand({ lightField: request.lightField, pathFile: request.pathFile, output: folder, options }),
    rendererCommand({ packageFolder: folder, output: request.output, options }),
  ];
}

// Returns the options with which a light field was opened, from the words of a command line.
export function lightFieldOptions(words: readonly string[]): LightFieldOptions {
  const options: Record<string, string | number> = {};
  for (let i = 0; i + 1 < words.length; i += 2)
    for (const [name, { flag, initial }] of Object.entries(kLightField))
      if (words[i] === flag) options[name] = typeof initial === "number" ? Number(words[i + 1]) : words[i + 1];
  return options;
}

// Returns a text as one word of a POSIX shell.
export function quote(word: string): string {
  if (/^[A-Za-z0-9_@%+:,./-]+$/.test(word)) return word;
  return `'${word.replace(/'/g, "'\\''")}'`;
}

// Returns a file name as one word of a shell. "./" is put before a name that a program would take for an option or a
// list in brackets.
export function quoteFile(name: string): string {
  return quote(/^[-[]/.test(name) ? `./${name}` : name);
}

function flags(table: Record<string, Flag>, options: object, leftOut: readonly string[]): string[] {
  const given = options as Record<string, Value>;
  const words: string[] = [];
  for (const [name, { flag, initial, isFile }] of Object.entries(table)) {
    const value = leftOut.includes(name) ? undefined : given[name];
    if (value === undefined || value === "" || value === false || value === initial) continue;
    if (typeof value === "boolean") words.push(flag);
    else if (typeof value === "object") words.push(flag, ...value.map((x) => quote(String(x))));
    else if (isFile) words.push(flag, quoteFile(String(value)));
    else if (String(value).startsWith("-")) words.push(quote(`${flag}=${value}`));
    else words.push(flag, quote(String(value)));
  }
  return words;
}
