// Bundles the page's script and style: node build.mjs FOLDER writes FOLDER/page.js and FOLDER/page.css.
import { build } from "esbuild";

const folder = process.argv[2];
await build({
  entryPoints: { page: "src/main.js" },
  outdir: folder,
  bundle: true,
  minify: true,
  charset: "ascii",
  format: "iife",
  target: ["es2020"],
  legalComments: "inline",
  logLevel: "warning",
});
