// SPDX-License-Identifier: Apache-2.0
// A YAML text that is edited in place: an edit changes only the characters that it concerns. The package `yaml` is used
// only to find the positions of values. Its own output would move comments and change the format of numbers; therefore
// edits replace parts of the text.
import { Alias, Document, isAlias, isMap, isScalar, isSeq, parseDocument, visit } from "yaml";
import type { Node, Pair, Scalar, YAMLMap, YAMLSeq } from "yaml";

// A path to a value: keys of maps and indices of lists, from the root.
export type YamlPath = readonly (string | number)[];

interface Change {
  begin: number;
  end: number;
  text: string;
}

// A list in brackets whose line would become longer than this is converted to one line per item. Unit: characters.
const kLongestLine = 100;

type Container = YAMLMap<Node, Node | null> | YAMLSeq<Node>;

export class YamlText {
  private current = "";
  private document!: Document.Parsed;

  // Throws an Error if the text is no YAML (the message has line and column), or if its root is no map.
  constructor(text: string) {
    this.set(text);
  }

  get text(): string {
    return this.current;
  }

  // Replaces the text. Throws like the constructor if the new text is not valid, and then keeps the old text.
  set(text: string): void {
    const document = parseDocument(text);
    if (document.errors.length > 0) throw new Error(document.errors[0].message);
    if (!isMap(document.contents)) throw new Error("A path file has keys, such as 'fps: 30'");
    this.document = document;
    this.current = text;
  }

  has(path: YamlPath): boolean {
    return this.find(path) !== undefined;
  }

  // Returns the value at a path as plain numbers, strings, arrays and objects; undefined if there is none.
  value(path: YamlPath): unknown {
    const node = this.find(path);
    return node === undefined ? undefined : node === null ? null : node.toJS(this.document);
  }

  keys(path: YamlPath): string[] {
    const map = this.resolved(this.find(path));
    return isMap(map) ? map.items.map((pair) => keyOf(pair as Pair<Node, Node>)) : [];
  }

  // Replaces an existing value. An anchor before the value stays, so that the aliases of this anchor also get the new
  // value.
  replace(path: YamlPath, text: string): void {
    this.own(path.slice(0, -1));
    const node = this.find(path);
    if (node === undefined) throw missing(path);
    const isKeyed = typeof path[path.length - 1] === "string";
    if (node === null || (isEmptyNode(node) && isKeyed)) {
      const end = this.endOfPair(this.pair(path));
      const colon = this.current[end - 1] === ":" ? "" : ":";
      this.apply([{ begin: end, end, text: `${colon} ${text}` }]);
    } else if (isBlock(node) && isKeyed) {
      this.apply(this.blockToFlow(path, node, text));
    } else {
      this.apply([{ begin: node.range![0], end: this.endOf(node), text }]);
    }
  }

  // Adds a key to the map at `path`, after the key `after` if that exists, otherwise at the end. If `value` is an
  // array, it becomes a list with one line per item; in a map in braces, a list in brackets.
  add(path: YamlPath, key: string, value: string | readonly string[], after?: string): void {
    this.own(path);
    const node = this.find(path);
    const flow = Array.isArray(value) ? `[${value.join(", ")}]` : (value as string);
    if (node === undefined) throw missing(path);
    if (node === null || isEmptyNode(node) || isEmptyFlowMap(node)) {
      this.addFirst(path, node, key, value);
      return;
    }
    if (!isMap(node)) throw new Error(`'${path.join(".")}' should have keys`);
    const map = node as YAMLMap<Node, Node | null>;
    const found = map.items.find((pair) => keyOf(pair) === after);
    const previous = found ?? map.items[map.items.length - 1];
    const end = this.endOfPair(previous);
    if (map.flow) {
      this.apply([{ begin: end, end, text: `, ${key}: ${flow}` }]);
      return;
    }
    const indent = this.column(map.items[0].key.range![0]);
    this.insertLines(this.lineEnd(end), this.pairLines(indent, key, value));
  }

  // Removes a key with its value. A map that loses its last key becomes {}.
  remove(path: YamlPath): void {
    const parent = path.slice(0, -1);
    this.own(parent);
    const node = this.find(path);
    if (node === undefined) return;
    const pair = this.pair(path);
    const map = this.resolved(this.find(parent)) as YAMLMap<Node, Node | null>;
    if (map.items.length === 1 && parent.length > 0 && !map.flow) {
      this.replace(parent, "{}");
      return;
    }
    if (map.flow) {
      this.apply(this.fromFlow(map.items, map.items.indexOf(pair)));
      return;
    }
    const begin = this.lineStart(pair.key.range![0]);
    if (this.current.slice(begin, pair.key.range![0]).trim() !== "")
      throw new Error(`'${path.join(".")}' cannot be removed from a list in this form`);
    this.apply([{ begin, end: this.nextLine(this.endOfPair(pair)), text: "" }]);
  }

  // Inserts an item into a list, before the item that has this index now.
  insertItem(path: YamlPath, index: number, text: string): void {
    this.own(path);
    const list = this.list(path);
    if (list.flow) {
      this.insertFlowItem(path, list, index, text);
      return;
    }
    const column = this.column(list.range![0]);
    const line = `${" ".repeat(column)}- ${text}`;
    if (index > 0) {
      // The new line is put directly after the previous item, so that comments above the next item stay there.
      this.insertLines(this.lineEnd(this.endOf(list.items[index - 1])), [line]);
    } else {
      const begin = this.dashLine(list, 0);
      this.apply([{ begin, end: begin, text: line + this.eol() }]);
    }
  }

  // Removes an item of a list. If the list has no other item, its key is also removed.
  removeItem(path: YamlPath, index: number): void {
    this.own(path);
    const list = this.list(path);
    if (list.items.length === 1) {
      this.remove(path);
    } else if (list.flow) {
      this.apply(this.fromFlow(list.items, index));
    } else {
      const begin = this.dashLine(list, index);
      this.apply([{ begin, end: this.nextLine(this.endOf(list.items[index])), text: "" }]);
    }
  }

  // Returns the text of a value on one line. A value of several lines is converted to the form in brackets.
  flowText(path: YamlPath): string {
    const node = this.find(path);
    if (!node) return "null";
    return this.flowOf(node);
  }

  // -------------------------------------------------------------------------- positions

  // Returns the node at a path as it is written, which may be an alias; null for a key without a value; undefined if
  // there is none.
  private find(path: YamlPath): Node | null | undefined {
    let node: Node | null | undefined = this.document.contents;
    for (const step of path) {
      const parent = this.resolved(node);
      if (isMap(parent) && typeof step === "string") {
        const pair = (parent as YAMLMap<Node, Node | null>).items.find((p) => keyOf(p) === step);
        node = pair === undefined ? undefined : pair.value;
      } else if (isSeq(parent) && typeof step === "number") {
        node = parent.items[step] as Node | undefined;
      } else {
        return undefined;
      }
    }
    return node;
  }

  private resolved(node: Node | null | undefined): Node | null | undefined {
    return isAlias(node) ? node.resolve(this.document) : node;
  }

  private pair(path: YamlPath): Pair<Node, Node | null> {
    const map = this.resolved(this.find(path.slice(0, -1))) as YAMLMap<Node, Node | null>;
    return map.items.find((pair) => keyOf(pair) === path[path.length - 1])!;
  }

  private list(path: YamlPath): YAMLSeq<Node> {
    const node = this.find(path);
    if (!isSeq(node)) throw new Error(`'${path.join(".")}' should be a list`);
    return node as YAMLSeq<Node>;
  }

  // Returns the offset where a node begins, including its anchor, which is not in the node's range.
  private startOf(node: Node): number {
    const begin = node.range![0];
    const anchor = isAlias(node) ? undefined : (node as Scalar).anchor;
    return anchor ? this.current.lastIndexOf(`&${anchor}`, begin) : begin;
  }

  // Returns the offset where the content of a node ends, without the comments and blank lines after it.
  private endOf(node: Node): number {
    if (isBlock(node)) {
      const last = (node as Container).items[(node as Container).items.length - 1];
      return isMap(node) ? this.endOfPair(last as Pair<Node, Node | null>) : this.endOf(last as Node);
    }
    let end = node.range![1];
    while (end > node.range![0] && /\s/.test(this.current[end - 1])) --end;
    return end;
  }

  private endOfPair(pair: Pair<Node, Node | null>): number {
    if (pair.value && !isEmptyNode(pair.value)) return this.endOf(pair.value);
    const end = pair.key.range![1];
    const colon = /^\s*:/.exec(this.current.slice(end));
    return colon ? end + colon[0].length : end;
  }

  private lineStart(offset: number): number {
    return this.current.lastIndexOf("\n", offset - 1) + 1;
  }

  // Returns the offset of the line break that ends the line; at the last line, the end of the text.
  private lineEnd(offset: number): number {
    const end = this.current.indexOf("\n", offset);
    if (end < 0) return this.current.length;
    return end > offset && this.current[end - 1] === "\r" ? end - 1 : end;
  }

  private nextLine(offset: number): number {
    const end = this.current.indexOf("\n", offset);
    return end < 0 ? this.current.length : end + 1;
  }

  private column(offset: number): number {
    return offset - this.lineStart(offset);
  }

  private eol(): string {
    return this.current.includes("\r\n") ? "\r\n" : "\n";
  }

  // Returns the offset where the line with the dash of an item begins.
  private dashLine(list: YAMLSeq<Node>, index: number): number {
    const column = this.column(list.range![0]);
    let line = this.lineStart(this.startOf(list.items[index]));
    while (!/^ *-$/.test(this.current.slice(line, line + column + 1))) {
      if (line === 0) throw new Error("A list in this form cannot be edited");
      line = this.lineStart(line - 1);
    }
    return line;
  }

  // --------------------------------------------------------------------------------- changes

  // Inserts lines after the line that ends at offset `end`.
  private insertLines(end: number, lines: readonly string[]): void {
    const text = lines.map((line) => this.eol() + line).join("");
    this.apply([{ begin: end, end, text }]);
  }

  private pairLines(indent: number, key: string, value: string | readonly string[]): string[] {
    const space = " ".repeat(indent);
    if (!Array.isArray(value)) return [`${space}${key}: ${value as string}`];
    return [`${space}${key}:`, ...(value as string[]).map((item) => `${space}  - ${item}`)];
  }

  private addFirst(path: YamlPath, node: Node | null, key: string, value: string | readonly string[]): void {
    const pair = this.pair(path);
    const keyStart = pair.key.range![0];
    if (this.current.slice(this.lineStart(keyStart), keyStart).trim() !== "") {
      const flow = Array.isArray(value) ? `[${value.join(", ")}]` : (value as string);
      this.replace(path, `{${key}: ${flow}}`);
      return;
    }
    if (node && !isEmptyNode(node)) {
      const begin = this.startOf(node) - (this.current[this.startOf(node) - 1] === " " ? 1 : 0);
      this.apply([{ begin, end: this.endOf(node), text: "" }]);
    }
    const key_node = this.pair(path).key;
    this.insertLines(this.lineEnd(key_node.range![1]), this.pairLines(this.column(key_node.range![0]) + 2, key, value));
  }

  // Returns the changes that replace a value of several lines by a text on the line of its key.
  private blockToFlow(path: YamlPath, node: Node, text: string): Change[] {
    let end = this.current.indexOf(":", this.pair(path).key.range![1]) + 1;
    const anchor = (node as Container).anchor;
    if (anchor) end = this.startOf(node) + anchor.length + 1;
    return [
      { begin: end, end, text: ` ${text}` },
      { begin: this.lineStart(node.range![0]), end: this.nextLine(this.endOf(node)), text: "" },
    ];
  }

  private fromFlow(items: readonly (Node | Pair<Node, Node | null>)[], index: number): Change[] {
    const item = items[index];
    const begin = this.startOf("key" in item ? item.key : item);
    const end = this.endOfItem(item);
    if (index + 1 < items.length) {
      const next = items[index + 1];
      return [{ begin, end: this.startOf("key" in next ? next.key : next), text: "" }];
    }
    if (index === 0) return [{ begin, end, text: "" }];
    const before = this.endOfItem(items[index - 1]);
    const between = this.current.slice(before, begin);
    if (!between.includes("\n")) return [{ begin: before, end, text: "" }];
    // The item is on another line than the previous item. Comments after the previous item stay; only the comma is
    // removed.
    const comma = between.indexOf(",");
    return [
      { begin: before + comma, end: before + comma + 1, text: "" },
      { begin, end, text: "" },
    ];
  }

  private endOfItem(item: Node | Pair<Node, Node | null>): number {
    return "key" in item ? this.endOfPair(item) : this.endOf(item);
  }

  private insertFlowItem(path: YamlPath, list: YAMLSeq<Node>, index: number, text: string): void {
    const begin = list.range![0];
    const source = this.current.slice(begin, this.endOf(list));
    const long = this.column(begin) + source.length + text.length + 2 > kLongestLine;
    if (long && !source.includes("\n") && list.items.length > 0 && !list.anchor && this.ownsItsLine(path)) {
      const items = list.items.map((item) => this.current.slice(this.startOf(item), this.endOf(item)));
      items.splice(index, 0, text);
      const space = " ".repeat(this.column(this.pair(path).key.range![0]) + 2);
      const end = this.endOf(list);
      this.apply(
        [
          // Removes the list, but not a comment after it, which stays on the line of the key.
          { begin: begin - (this.current[begin - 1] === " " ? 1 : 0), end, text: "" },
          {
            begin: this.lineEnd(end),
            end: this.lineEnd(end),
            text: items.map((item) => `${this.eol()}${space}- ${item}`).join(""),
          },
        ],
        true,
      );
      return;
    }
    if (list.items.length === 0) {
      this.apply([{ begin: begin + 1, end: begin + 1, text }]);
    } else if (index > 0) {
      const end = this.endOf(list.items[index - 1]);
      this.apply([{ begin: end, end, text: `, ${text}` }]);
    } else {
      const first = this.startOf(list.items[0]);
      this.apply([{ begin: first, end: first, text: `${text}, ` }]);
    }
  }

  // Returns true if the key is the first on its line, and nothing but a comment follows its value.
  private ownsItsLine(path: YamlPath): boolean {
    const pair = this.pair(path);
    const begin = pair.key.range![0];
    const end = this.endOfPair(pair);
    return (
      this.current.slice(this.lineStart(begin), begin).trim() === "" &&
      /^\s*(#.*)?$/.test(this.current.slice(end, this.lineEnd(end)))
    );
  }

  // Replaces every alias on the path by a copy of its value, so that an edit below it does not change the value of the
  // anchor.
  private own(path: YamlPath): void {
    for (let length = 1; length <= path.length; ++length) {
      const node = this.find(path.slice(0, length));
      if (isAlias(node)) this.apply([{ begin: node.range![0], end: node.range![1], text: this.flowOf(node) }]);
    }
  }

  private flowOf(node: Node): string {
    const target = this.resolved(node);
    if (!target) return "null";
    const source = this.current.slice(target.range![0], this.endOf(target));
    if (!isBlock(target) && !/[\n&*]/.test(source)) return source;
    const copy = new Document(target.toJS(this.document));
    return copy.toString({ collectionStyle: "flow", flowCollectionPadding: false, lineWidth: 0 }).trim();
  }

  // Applies changes to the text. If a change removes a node with an anchor, its aliases are replaced by copies;
  // keepsAnchors must be true if the changes only move such nodes.
  private apply(changes: Change[], keepsAnchors = false): void {
    const all = keepsAnchors ? changes : [...changes, ...this.orphans(changes)];
    all.sort((a, b) => b.begin - a.begin || b.end - a.end);
    let text = this.current;
    for (const { begin, end, text: inserted } of all) text = text.slice(0, begin) + inserted + text.slice(end);
    this.set(text);
  }

  private orphans(changes: readonly Change[]): Change[] {
    const inside = (offset: number): boolean => changes.some(({ begin, end }) => begin <= offset && offset < end);
    const copies: Change[] = [];
    visit(this.document, {
      Alias: (_, alias: Alias) => {
        const target = this.resolved(alias);
        if (!target || inside(alias.range![0]) || !inside(this.startOf(target))) return;
        copies.push({ begin: alias.range![0], end: alias.range![1], text: this.flowOf(alias) });
      },
    });
    return copies;
  }
}

function missing(path: YamlPath): Error {
  return new Error(`The path has no '${path.join(".")}'`);
}

function keyOf(pair: Pair<Node, Node | null>): string {
  return isScalar(pair.key) ? String(pair.key.value) : "";
}

function isBlock(node: Node): boolean {
  return (isMap(node) || isSeq(node)) && !node.flow;
}

function isEmptyNode(node: Node): boolean {
  return isScalar(node) && node.range![0] === node.range![1];
}

function isEmptyFlowMap(node: Node): boolean {
  return isMap(node) && node.flow === true && node.items.length === 0;
}
