// Colours of the picture, for a light and a dark page.

const THEMES = {
  light: { base: "#b9c2cb", edge: "#3b4651", kept: "#b9c2cb", fresh: "#1f9e86", gone: "#e0882f", cut: "#6d7c8c", grid: "#8b97a3", back: "#cf3f36" },
  dark: { base: "#93a0ad", edge: "#10151a", kept: "#8a97a4", fresh: "#2fbf9f", gone: "#f09a45", cut: "#55636f", grid: "#5a6672", back: "#e2574d" },
};

const DEFECTS = {
  "boundary-loop": "#f2731c", "open-sheet": "#f2a51c", "isolated-face": "#f2a51c",
  "non-manifold-edge": "#a83ad0", "non-manifold-vertex": "#a83ad0", "non-orientable": "#3a63d0",
  "orientation-conflict": "#2f7fe0", "inverted-shell": "#2f7fe0", "misnested-shell": "#3a63d0",
  "self-intersection": "#e0357f", "overlap": "#e0357f", "touch": "#e0609a", "near": "#e0609a",
  "needle": "#0c9ab0", "cap": "#0c9ab0", "folded-edge": "#0c9ab0", "collinear-face": "#0c9ab0", "coincident-corners": "#0c9ab0",
};

// From much to little, as the ramp of the shader and the legend have it.
export const RAMP = ["#3b6fb6", "#9ccbe0", "#f3c35b", "#d0342c"];

export const theme = (name) => THEMES[name];
export const ofDefect = (code) => DEFECTS[code] ?? "#8a6d1c";
export const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
