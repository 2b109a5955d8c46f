// Draws the design tokens of theme.css as an image: the colors of each theme, the sizes of texts,
// the spaces and the corners.

const kThemes = [
  ["light", "\n:root {"],
  ["dark", ':root[data-theme="dark"] {'],
  ["contrast", ':root[data-theme="contrast"] {'],
] as const;
const kColumnPx = 300;
const kRowPx = 30;
const kTopPx = 56;
const kEdgePx = 24;

/** Returns the declarations of the block that begins with `head`. */
function blockOf(css: string, head: string): [name: string, value: string][] {
  const start = css.indexOf(head) + head.length;
  const block = css.slice(start, css.indexOf("\n}", start)).replace(/\/\*[^]*?\*\//g, "");
  return [...block.matchAll(/--([\w-]+): ([^;]+);/g)].map(([, name, value]) => [name!, value!]);
}

const isColor = (value: string): boolean => /^#[0-9a-f]{6}$/.test(value);
const px = (value: string): number =>
  value.endsWith("rem") ? parseFloat(value) * 16 : parseFloat(value);

/** Returns the text of an SVG file. `css` is the text of theme.css. */
export function designSheet(css: string): string {
  const light = new Map(blockOf(css, kThemes[0][1]).filter(([, value]) => isColor(value)));
  // the marks are the same in each theme, and are drawn over the model
  const names = [...light.keys()].filter((name) => !/^(mark|ball|logo)-/.test(name));
  const measures = blockOf(css.slice(css.indexOf("/* Measures")), "\n:root {");
  const of = (kind: string): [string, string][] =>
    measures.filter(([name]) => name.startsWith(kind));
  const column = (index: number): number => kEdgePx + index * kColumnPx;
  const row = (index: number): number => kTopPx + index * kRowPx;
  const text = (x: number, y: number, words: string, more = ""): string =>
    `<text x="${x}" y="${y}" ${more}>${words}</text>`;
  const lines: string[] = [];

  kThemes.forEach(([theme, head], index) => {
    const colors = new Map([...light, ...blockOf(css, head)]);
    const x = column(index);
    lines.push(
      `<rect x="${x - 12}" y="16" width="${kColumnPx - 12}" height="${row(names.length) - 12}" rx="10" fill="${colors.get("paper")}" stroke="#847d70"/>`,
      text(x, 40, theme, `font-weight="600" fill="${colors.get("ink")}"`),
    );
    names.forEach((name, at) => {
      const value = colors.get(name)!;
      lines.push(
        `<rect x="${x}" y="${row(at)}" width="56" height="22" rx="6" fill="${value}" stroke="${colors.get("line-strong")}"/>`,
        text(x + 68, row(at) + 16, `--${name}`, `fill="${colors.get("ink")}"`),
        text(
          x + kColumnPx - 36,
          row(at) + 16,
          value,
          `text-anchor="end" fill="${colors.get("ink-soft")}"`,
        ),
      );
    });
  });

  const x = column(kThemes.length) + 12;
  let y = 40;
  const title = (words: string): void => {
    lines.push(text(x, y, words, 'font-weight="600"'));
    y += 12;
  };
  title("Sizes of texts");
  for (const [name, value] of of("text-")) {
    y += Math.max(24, px(value) + 10);
    lines.push(text(x, y, `--${name}, ${px(value)} px`, `style="font-size:${px(value)}px"`));
  }
  y += 44;
  title("Space");
  for (const [name, value] of of("space-")) {
    lines.push(
      `<rect x="${x}" y="${y}" width="${px(value)}" height="16" fill="#97441f"/>`,
      text(x + 64, y + 13, `--${name}, ${px(value)} px`),
    );
    y += 24;
  }
  y += 32;
  title("Corners");
  for (const [name, value] of of("radius")) {
    lines.push(
      `<rect x="${x}" y="${y}" width="48" height="32" rx="${Math.min(16, px(value))}" fill="#f6e6dc" stroke="#97441f"/>`,
      text(x + 64, y + 20, `--${name}, ${px(value)} px`),
    );
    y += 40;
  }

  const width = x + kColumnPx;
  const height = Math.max(y, row(names.length)) + kEdgePx;
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="Inter, Arial, sans-serif" font-size="13">
<rect width="100%" height="100%" fill="#ffffff"/>
${lines.join("\n")}
</svg>
`;
}
