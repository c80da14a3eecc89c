// Bundles src/ into pages without data: build.mjs FOLDER. A page contains scripts and styles, and
// a policy that allows exactly these and no connections.
import { createHash } from "node:crypto";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const folder = path.dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (!out) throw new Error("usage: build.mjs FOLDER");

/// Licences of the bundled packages, as first comment of the page.
async function licences(packages) {
  const texts = await Promise.all(
    packages.map(
      async (name) => `${name}\n\n${await readFile(path.join(folder, "node_modules", name, "LICENSE"), "utf8")}`,
    ),
  );
  return `/*!\n${texts.join("\n").replaceAll("*/", "* /")}*/`;
}

const hash = (text) => `'sha256-${createHash("sha256").update(text, "utf8").digest("base64")}'`;

/// The page of an entry point that uses these packages.
async function page(entry, title, packages) {
  const result = await build({
    entryPoints: [path.join(folder, "src", entry)],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    charset: "utf8",
    legalComments: "none", // in the banner
    banner: { js: await licences(packages) },
    outdir: "out",
    write: false,
  });
  const bundle = (ending) => result.outputFiles.find((file) => file.path.endsWith(ending)).text;
  const script = bundle(".js");
  const style = bundle(".css");
  // An end tag inside the script would end its element.
  if (/<\/script/i.test(script) || /<\/style/i.test(style)) throw new Error("the bundle contains an end tag");

  const policy = `default-src 'none'; script-src ${hash(script)}; style-src ${hash(style)}; img-src data: blob:`;
  // The policy contains hashes of the exact texts, so these elements of page.html stay empty: a
  // formatter would change them.
  const template = await readFile(path.join(folder, "src/page.html"), "utf8");
  return [
    ["POLICY", policy],
    ["<title></title>", `<title>${title}</title>`],
    ["<style></style>", `<style>${style}</style>`],
    ["<script></script>", `<script>${script}</script>`],
  ].reduce((text, [empty, full]) => {
    if (text.split(empty).length !== 2) throw new Error(`page.html: need ${empty} once`);
    return text.replace(empty, () => full);
  }, template);
}

await mkdir(path.resolve(out), { recursive: true });
await writeFile(path.join(out, "report.html"), await page("main.ts", "Prowl report", ["three", "uplot"]));
await writeFile(path.join(out, "online.html"), await page("online.ts", "Prowl online", ["three", "uplot"]));
await writeFile(path.join(out, "library.html"), await page("library.ts", "Prowl library", ["uplot"]));
