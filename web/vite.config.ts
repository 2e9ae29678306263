// vite.config.ts — builds each page into one HTML file that asks nothing of any network: the report's, and with
// `--mode live` that of the live view.
//
// Scripts, styles and fonts are inlined; the place of the data stays a single token that the program
// splits the file at, so the build stops if the token is not there exactly once.
import { readFileSync } from "node:fs";
import { defineConfig, type Plugin, type UserConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

const DATA_TOKEN = "/*GLISSON" + "_DATA*/";

/** Fails the build unless the page holds the data token exactly once, as the text of its script element. */
function requireDataToken(): Plugin {
  return {
    name: "glisson-data-token",
    enforce: "post",
    generateBundle: {
      order: "post",
      handler(_options, bundle) {
        const page = bundle["report.html"];
        const html = page?.type === "asset" ? String(page.source) : "";
        const element = `<script id="glisson-data" type="application/json">${DATA_TOKEN}</script>`;
        if (html.split(DATA_TOKEN).length !== 2 || !html.includes(element)) {
          this.error(`report.html must hold ${element} exactly once`);
        }
      },
    },
  };
}

const CONTAINED = ["three", "uplot", "@fontsource-variable/source-sans-3"];

/** Puts the licences of what the page contains into a comment at its end. */
function licences(): Plugin {
  const texts = CONTAINED.map((name) => {
    const file = new URL(`node_modules/${name}/LICENSE`, import.meta.url);
    return `${name}\n\n${readFileSync(file, "utf8").trim().replace(/-{2,}/g, "")}`;
  });
  const comment = `<!--\nThis page contains the following works under their licences.\n\n${texts.join("\n\n\n")}\n-->\n`;
  return {
    name: "glisson-licences",
    transformIndexHtml: { order: "post", handler: (html) => html.replace("</html>", () => `${comment}</html>`) },
  };
}

export default defineConfig(({ mode }) => {
  const live = mode === "live";
  return {
    base: "./",
    plugins: [viteSingleFile({ removeViteModuleLoader: true }), licences(), ...(live ? [] : [requireDataToken()])],
    build: {
      target: "es2020",
      rollupOptions: { input: live ? "live.html" : "report.html" },
      emptyOutDir: !live,
      assetsInlineLimit: 100_000_000,
      cssCodeSplit: false,
      modulePreload: false,
      chunkSizeWarningLimit: 2000,
      reportCompressedSize: false,
    },
    server: { host: "127.0.0.1" }, // a container without a file of hosts does not know "localhost"
    test: { include: ["test/**/*.test.ts"] },
  } as UserConfig;
});
