// Bundles the page into src/clutchwork/page/static, or its tests into build/page/tests.
import { build } from "esbuild";
import { copyFile, mkdir, readdir } from "node:fs/promises";
import { fileURLToPath } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const root = `${here}../../`;
const common = { bundle: true, legalComments: "none", logLevel: "warning", absWorkingDir: here };

if (process.argv.includes("--tests")) {
  const tests = (await readdir(`${here}test`)).filter((name) => name.endsWith(".test.ts"));
  await build({
    ...common,
    entryPoints: tests.map((name) => `test/${name}`),
    outdir: `${root}build/page/tests`,
    outExtension: { ".js": ".mjs" },
    platform: "node",
    format: "esm",
  });
} else {
  const folder = `${root}src/clutchwork/page/static`;
  await mkdir(folder, { recursive: true });
  const browser = { ...common, minify: true, target: "es2022" };
  await build({ ...browser, entryPoints: ["src/page.ts"], outfile: `${folder}/page.js`, format: "iife", charset: "utf8" });
  await build({ ...browser, entryPoints: ["src/gearbox.ts"], outfile: `${folder}/gearbox.js`, format: "iife", charset: "utf8" });
  await build({ ...browser, entryPoints: ["src/widget.ts"], outfile: `${folder}/widget.js`, format: "esm", charset: "utf8" });
  await build({ ...browser, entryPoints: ["src/page.css"], outfile: `${folder}/page.css` });
  // what programs without a browser use: tests of Python run the page's own engine by it
  await build({ ...common, entryPoints: ["src/node.ts"], outfile: `${root}build/page/node.mjs`, platform: "node", format: "esm" });
  await copyFile(`${here}node_modules/uplot/LICENSE`, `${folder}/uplot.LICENSE`);
}
