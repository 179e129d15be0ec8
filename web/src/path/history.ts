// SPDX-License-Identifier: Apache-2.0
// The history of edits, for undo and redo: the texts of a path, each with the name of the edit that made it.

interface Entry {
  text: string;
  label: string;
  open: boolean; // true: the next push() with `merge` and the same label replaces the text
}

export class History {
  private entries: Entry[];
  private at = 0;

  // most  largest number of edits that can be undone; older edits are forgotten
  constructor(
    text: string,
    private readonly most = 200,
  ) {
    this.entries = [{ text, label: "", open: false }];
  }

  get text(): string {
    return this.entries[this.at].text;
  }

  // Adds an edit. merge: true if the edit belongs to a drag or to typing. The edit then replaces the previous edit, if
  // that was also pushed with `merge` and the same label, and if neither seal() nor undo() nor redo() was called in
  // between. Pushing the current text changes nothing.
  push(text: string, label: string, options: { merge?: boolean } = {}): void {
    const merge = options.merge ?? false;
    if (text === this.text) return;
    this.entries.length = this.at + 1;
    const last = this.entries[this.at];
    if (merge && last.open && last.label === label) {
      last.text = text;
      return;
    }
    last.open = false;
    this.entries.push({ text, label, open: merge });
    this.entries.splice(0, this.entries.length - 1 - this.most);
    this.at = this.entries.length - 1;
  }

  // Ends a drag or typing: the next edit does not replace the current one.
  seal(): void {
    this.entries[this.at].open = false;
  }

  get canUndo(): boolean {
    return this.at > 0;
  }

  get canRedo(): boolean {
    return this.at + 1 < this.entries.length;
  }

  // The name of the edit that undo() would undo; undefined if there is none.
  get undoLabel(): string | undefined {
    return this.canUndo ? this.entries[this.at].label : undefined;
  }

  get redoLabel(): string | undefined {
    return this.entries[this.at + 1]?.label;
  }

  // The names of all stored edits, oldest first. The current text contains the first `done` of them.
  get labels(): string[] {
    return this.entries.slice(1).map((entry) => entry.label);
  }

  get done(): number {
    return this.at;
  }

  // Goes back by one edit and returns its text; undefined if there is nothing to undo.
  undo(): string | undefined {
    if (!this.canUndo) return undefined;
    --this.at;
    this.seal();
    return this.text;
  }

  redo(): string | undefined {
    if (!this.canRedo) return undefined;
    ++this.at;
    this.seal();
    return this.text;
  }
}
