// Who is to render live pictures, by the address of the page: ?live=webgl or ?live=server, for tests and measurements.

export type Wish = "auto" | "webgl" | "server";

export function wishOf(search: string): Wish {
  const wish = new URLSearchParams(search).get("live");
  return wish === "webgl" || wish === "server" ? wish : "auto";
}
