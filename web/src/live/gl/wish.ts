// SPDX-License-Identifier: Apache-2.0
// The renderer of live pictures that the address of the page asks for, ?live=webgl or ?live=server, for tests and
// measurements; "auto" if it asks for none.

export type Wish = "auto" | "webgl" | "server";

export function wishOf(search: string): Wish {
  const wish = new URLSearchParams(search).get("live");
  return wish === "webgl" || wish === "server" ? wish : "auto";
}
