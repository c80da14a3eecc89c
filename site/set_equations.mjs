// Reads [{tex, display}, ...] from stdin and writes the HTML of each, for site/hooks/equations.py.
import { readFileSync } from "node:fs";
import katex from "katex";

const equations = JSON.parse(readFileSync(0, "utf8"));
const set = equations.map(({ tex, display }) => {
  try {
    return katex.renderToString(tex, {
      displayMode: display,
      throwOnError: true,
      strict: "error",
      output: "htmlAndMathml",
    });
  } catch (error) {
    console.error(`an equation does not parse: ${error.message}\n${tex}`);
    process.exit(1);
  }
});
process.stdout.write(JSON.stringify(set));
