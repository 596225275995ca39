// The page without its face, for programs that have no browser: tests, and tables of many positions.
export { Core } from "./core";
export { Session } from "./session";
export { evaluated } from "./forms";
export { asCsv, asPython, asToml } from "./copies";
export { unpacked } from "./bytes";
export { moved } from "./tables";
export { measures, strokes } from "./measures";
export { stateOf, take } from "./state";
