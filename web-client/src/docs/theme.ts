// Replaces the Redoc colors that have too little contrast (WCAG 2.2, 1.4.3). A response has one
// color on the light page and another on the dark tabs of its samples.
import type { AppStore } from "redoc";

type Options = NonNullable<ConstructorParameters<typeof AppStore>[2]>;

export const kTheme: NonNullable<Options["theme"]> = {
  colors: {
    text: { secondary: "#5a5f63" },
    responses: {
      success: { color: "#17661f", tabTextColor: "#7fdb8a" },
      redirect: { color: "#7a4f00", tabTextColor: "#ffc966" },
      error: { color: "#b01512", tabTextColor: "#ff9c94" },
      info: { color: "#1d5f8a", tabTextColor: "#8ec3ee" },
    },
  },
  typography: {
    fontFamily: "var(--sans)",
    headings: { fontFamily: "var(--sans)" },
    code: { color: "#8f1d1a", fontFamily: "var(--mono)" },
  },
  sidebar: { width: "300px" },
};
