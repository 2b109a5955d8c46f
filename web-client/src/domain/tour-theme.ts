// The design of a tour's kiosks: two colors, from which all other colors are derived, and checks
// that ensure readable text. The server makes the same checks
// (server/net/serialization/tour_theme.cpp).

import type { Background, TourMode, TourTheme } from "../core/protocol.gen";

interface ModeColors {
  ink: string;
  background: string;
  accent: string;
}
/** The default colors of each mode, as `#rrggbb`. */
export const kModeColors: Record<TourMode, ModeColors> = {
  light: { ink: "#20292a", background: "#dedad3", accent: "#2c6a63" },
  dark: { ink: "#ebe6da", background: "#14181a", accent: "#7fc0b5" },
};
export const kLeastTextContrast = 7; // visitors read the text from a distance
export const kLeastAccentContrast = 3;

/** The fraction of white in the upper end of the background. */
const kLighterTop: Record<TourMode, number> = { light: 0.45, dark: 0.07 };

/** The fraction of white in the panel with the texts. */
const kLighterSurface: Record<TourMode, number> = { light: 0.78, dark: 0.08 };

const channels = (color: string): number[] =>
  [1, 3, 5].map((at) => Number.parseInt(color.slice(at, at + 2), 16));

/** Returns the contrast ratio of two colors, 1 to 21 (WCAG 2.2). */
export function contrast(a: string, b: string): number {
  const luminance = (color: string): number => {
    const [r, g, blue] = channels(color).map((value) => {
      const part = value / 255;
      return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r! + 0.7152 * g! + 0.0722 * blue!;
  };
  const [one, other] = [luminance(a), luminance(b)];
  return (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
}

function mixed(color: string, other: string, share: number): string {
  const [from, to] = [channels(color), channels(other)];
  return `#${from
    .map((value, at) => Math.round(value + (to[at]! - value) * share))
    .map((value) => value.toString(16).padStart(2, "0"))
    .join("")}`;
}

export const modeOf = (theme: TourTheme | undefined): TourMode => theme?.mode ?? "light";

function colorsOf(theme: TourTheme | undefined): ModeColors {
  const { ink, background, accent } = kModeColors[modeOf(theme)];
  return { ink, background: theme?.background ?? background, accent: theme?.accent ?? accent };
}

/** Returns the background of the object, which the server draws. */
export function roomOf(theme: TourTheme | undefined): Background {
  const { background } = colorsOf(theme);
  return { top: mixed(background, "#ffffff", kLighterTop[modeOf(theme)]), bottom: background };
}

/** Returns the custom CSS properties of the kiosk page. */
export function propertiesOf(theme: TourTheme | undefined): Record<string, string> {
  const { ink, accent } = colorsOf(theme);
  const { top, bottom } = roomOf(theme);
  const dark = "#10181a";
  return {
    "--ink": ink,
    "--room": bottom,
    "--room-top": top,
    "--surface": mixed(bottom, "#ffffff", kLighterSurface[modeOf(theme)]),
    "--accent": accent,
    "--accent-ink": contrast(accent, "#ffffff") >= contrast(accent, dark) ? "#ffffff" : dark,
    "--heading": theme?.font === "sans" ? "var(--sans)" : "var(--serif)",
  };
}

export interface ThemeProblem {
  field: "background" | "accent";
  contrast: number;
  needed: number;
}

/** Returns the first problem with too little contrast, or null. */
export function problemOfTheme(theme: TourTheme | undefined): ThemeProblem | null {
  const { ink, background, accent } = colorsOf(theme);
  const text = contrast(ink, background);
  if (text < kLeastTextContrast)
    return { field: "background", contrast: text, needed: kLeastTextContrast };
  const buttons = contrast(accent, background);
  return buttons < kLeastAccentContrast
    ? {
        field: theme?.accent === undefined ? "background" : "accent",
        contrast: buttons,
        needed: kLeastAccentContrast,
      }
    : null;
}
