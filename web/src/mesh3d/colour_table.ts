// colour_table.ts — colours of equal OKLab distance, low to high; made by scripts/make_colour_table.mjs.
export const COLOUR_TABLE: readonly string[] = [
  "#511d84", "#4f268e", "#4c2f97", "#47389f", "#4241a7", "#3a4aae", "#3052b4", "#215bb9",
  "#1964b6", "#1c6bb0", "#1e73ac", "#207aaa", "#2382a9", "#258aa9", "#2892aa", "#2a9aaa",
  "#2da2aa", "#2faaaa", "#32b2a8", "#34b9a6", "#36c1a3", "#38c89e", "#3ace97", "#40d48f",
  "#5dd888", "#75dc80", "#8be079", "#9fe372", "#b3e56c", "#c5e766", "#d7e962", "#e9eb5f",
  "#faed5f",
];
