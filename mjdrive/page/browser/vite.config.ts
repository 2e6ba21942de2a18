// The built page lies beside its source and is committed: users of mjdrive need no Node. Names carry no digest, so that a
// change of the page is a change of these files and not a pile of new ones.
export default {
  base: "./",
  worker: { format: "es", rollupOptions: { output: { entryFileNames: "[name].js" } } },
  build: {
    outDir: "../static",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 900,
    rolldownOptions: {
      output: { codeSplitting: false, entryFileNames: "page.js", assetFileNames: "page[extname]" },
    },
  },
};
