// Icons as line drawings on a 24 × 24 grid. The style `svg.glyph` sets their size and color.

import { html, svg, type SVGTemplateResult, type TemplateResult } from "lit";

const shapes = {
  orbit: svg`<ellipse cx="12" cy="12" rx="9" ry="3.6" /><path d="M12 3c-2.2 0-3.6 4-3.6 9s1.4 9 3.6 9 3.6-4 3.6-9" /><path d="M13.6 5.6 15.6 12l2.6-5" />`,
  pan: svg`<path d="M12 3v18M3 12h18M9.5 5.5 12 3l2.5 2.5M9.5 18.5 12 21l2.5-2.5M5.5 9.5 3 12l2.5 2.5M18.5 9.5 21 12l-2.5 2.5" />`,
  brush: svg`<path d="M20.5 3.5c-4 1.6-8 5-10.5 8.7l1.8 1.8C15.5 11.5 18.9 7.5 20.5 3.500Z" /><path d="M9.7 12.600c-2.5 0-3.9 1.4-4.2 3.4-.2 1.7-1 2.6-2.5 3.2 3.2 1.4 8.4.9 8.6-4.2" />`,
  eraser: svg`<path d="m8.5 20-4.7-4.700a1.6 1.6 0 0 1 0-2.200l8.7-8.700a1.6 1.6 0 0 1 2.2 0l4.9 4.900a1.6 1.6 0 0 1 0 2.200L11 20Z" /><path d="m8.4 8.5 7.1 7.100M6.5 20H20" />`,
  pick: svg`<path d="m13.5 6.5 4 4M4 20l1-4 8.3-8.3 3 3L8 19Z" /><path d="m15 5.5 1.2-1.200a2.1 2.1 0 0 1 3 0l.5.500a2.1 2.1 0 0 1 0 3L18.5 9" />`,
  polygon: svg`<path d="M5 8.5 13.5 4 20 12.5 15 19.500 6.5 17.500Z" /><path d="M5 8.500h.01M13.5 4h.01M20 12.500h.01M15 19.500h.01M6.5 17.500h.01" stroke-width="4" />`,
  lasso: svg`<path d="M7.5 15.300C5 14.400 3.5 12.700 3.5 10.700 3.5 7.300 7.300 4.500 12 4.500s8.500 2.800 8.500 6.200-3.800 6.200-8.500 6.200c-1 0-1.900-.1-2.700-.3" /><circle cx="7.8" cy="16.200" r="1.900" /><path d="M7.500 18.100c.4 1.200.1 2.100-1.100 2.900" />`,
  strokes: svg`<path d="M3.500 6.500c3.500-3 7 1.500 10.500-1.500" stroke-width="2.6" /><path d="M10 18.500c3.500-3 7 1.500 10.500-1.500" stroke-width="2.6" stroke-dasharray=".1 4" /><path d="M17.500 7h4M19.500 5v4M3 17h4" />`,
  wand: svg`<path d="m4 20 10.500-10.500M12.500 7.500l4 4" /><path d="M17 2.500v3M15.500 4h3M20.500 8.500v3M19 10h3M9 3.500v2M8 4.500h2" />`,
  bucket: svg`<path d="m11 3.500-6.700 6.700a1.500 1.500 0 0 0 0 2.100l5.400 5.400a1.500 1.500 0 0 0 2.100 0l6.700-6.700Z" /><path d="m8.500 6 3 3M4.200 11.500h13.500" /><path d="M20 14.500s1.700 2.300 1.700 3.600a1.700 1.700 0 0 1-3.400 0c0-1.300 1.700-3.600 1.700-3.600Z" />`,
  line: svg`<path d="M5.500 18c1.500-5.500 4-2.500 6-6s3-1.500 7-6.500" /><circle cx="4.800" cy="19.200" r="1.600" /><circle cx="19.400" cy="4.600" r="1.600" />`,
  point: svg`<path d="M12 21s-6-6.200-6-11a6 6 0 0 1 12 0c0 4.800-6 11-6 11Z" /><circle cx="12" cy="10" r="2" />`,
  comment: svg`<path d="M4 6.500A2 2 0 0 1 6 4.500h12a2 2 0 0 1 2 2v8a2 2 0 0 1-2 2h-6.500L7.500 20v-3.500H6a2 2 0 0 1-2-2Z" /><path d="M8 9h8M8 12.200h5" />`,
  measure: svg`<path d="M3.500 15.800 15.800 3.500a1 1 0 0 1 1.400 0l3.300 3.300a1 1 0 0 1 0 1.400L8.200 20.500a1 1 0 0 1-1.400 0L3.500 17.200a1 1 0 0 1 0-1.400Z" /><path d="m6.700 12.600 1.700 1.700M9.300 10l2.600 2.600M11.900 7.400l1.700 1.700M14.500 4.800l2.600 2.600" />`,
  formula: svg`<path d="M9 20c2 0 2.500-1.200 3-3.500l1.700-8.500c.5-2.500 1.300-4 3.300-4" /><path d="M9.500 10.500h6.500" />`,
  undo: svg`<path d="M8.5 5 4 9.5 8.5 14" /><path d="M4.5 9.500h9.200a5.3 5.3 0 0 1 0 10.500H9" />`,
  redo: svg`<path d="m15.5 5 4.5 4.5-4.5 4.5" /><path d="M19.5 9.500h-9.200a5.3 5.3 0 0 0 0 10.500H15" />`,
  cube: svg`<path d="m12 3 8 4.500v9L12 21l-8-4.500v-9Z" /><path d="m4 7.5 8 4.5 8-4.500M12 12v9" />`,
  clock: svg`<circle cx="12" cy="12" r="8.500" /><path d="M12 7v5l3.500 2" />`,
  home: svg`<path d="M4 11.500 12 4.500l8 7M6 10v9.500h4.500v-5h3v5H18V10" />`,
  fit: svg`<path d="M4 9V5.500A1.5 1.5 0 0 1 5.5 4H9M15 4h3.500A1.5 1.5 0 0 1 20 5.500V9M20 15v3.500a1.5 1.5 0 0 1-1.5 1.500H15M9 20H5.500A1.5 1.5 0 0 1 4 18.500V15" /><circle cx="12" cy="12" r="3.2" />`,
  help: svg`<circle cx="12" cy="12" r="9" /><path d="M9.3 9.300a2.8 2.8 0 1 1 4.1 2.500c-.9.5-1.4 1-1.4 2.2" /><path d="M12 17h.01" />`,
  info: svg`<circle cx="12" cy="12" r="9" /><path d="M12 11v5.500M12 7.500h.01" />`,
  back: svg`<path d="M19 12H5M11 6l-6 6 6 6" />`,
  chevron: svg`<path d="m9 6 6 6-6 6" />`,
  minus: svg`<path d="M5 12h14" />`,
  history: svg`<path d="M4 12a8 8 0 1 0 2.600-5.900L4 8.500" /><path d="M4 4v4.500h4.500M12 7.500V12l3 2" />`,
  play: svg`<path d="M8 5.500v13l10.500-6.500Z" />`,
  pause: svg`<path d="M8.500 5.500v13M15.500 5.500v13" stroke-width="2.4" />`,
  step_back: svg`<path d="M17.500 6v12L9 12ZM6.500 6v12" />`,
  step_on: svg`<path d="M6.500 6v12l8.500-6ZM17.500 6v12" />`,
  swipe: svg`<path d="M9 7.500 4.500 12 9 16.500M15 7.500l4.500 4.500-4.500 4.500" />`,
  plus: svg`<path d="M12 5v14M5 12h14" />`,
  close: svg`<path d="m6 6 12 12M18 6 6 18" />`,
  eye: svg`<path d="M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12Z" /><circle cx="12" cy="12" r="2.8" />`,
  eye_off: svg`<path d="M9.9 5.800A8.7 8.7 0 0 1 12 5.500c6 0 9.5 6.5 9.5 6.500a16 16 0 0 1-2.9 3.600M6.3 7.300A15.5 15.5 0 0 0 2.5 12S6 18.5 12 18.500a8.9 8.9 0 0 0 4.6-1.300M10 10a2.8 2.8 0 0 0 4 4M3.5 3.500l17 17" />`,
  more: svg`<path d="M5.5 12h.01M12 12h.01M18.5 12h.01" stroke-width="2.8" />`,
  up: svg`<path d="M12 19V5M6 11l6-6 6 6" />`,
  down: svg`<path d="M12 5v14M6 13l6 6 6-6" />`,
  grip: svg`<path d="M9 6h.01M15 6h.01M9 12h.01M15 12h.01M9 18h.01M15 18h.01" stroke-width="2.4" />`,
  edit: svg`<path d="M4 20h4L19 9a2.1 2.1 0 0 0-3-3L5 17ZM14.5 7.500l3 3" />`,
  trash: svg`<path d="M4.5 6.500h15M9.5 6.500V4.500h5v2M6.5 6.500l.8 13h9.400l.8-13M10 10.500v5.500M14 10.500v5.5" />`,
  chart: svg`<path d="M4 20h16M7 16.500V11M12 16.500V5M17 16.500V8.5" stroke-width="2.2" />`,
  check: svg`<path d="m5 12.5 4.5 4.500L19 7.5" />`,
  cloud: svg`<path d="M7 18.500a4.5 4.5 0 0 1-.5-9A6 6 0 0 1 18 10a4.3 4.3 0 0 1-.5 8.500Z" /><path d="M12 16v-4.500M9.8 13.2 12 11l2.2 2.2" />`,
  warning: svg`<path d="M12 4 2.8 19.500h18.400ZM12 10v4.500M12 17h.01" />`,
  upload: svg`<path d="M12 15.500V4.500M7.5 9 12 4.5 16.5 9M4.5 15.500v3a1.5 1.5 0 0 0 1.5 1.500h12a1.5 1.5 0 0 0 1.5-1.500v-3" />`,
  import: svg`<path d="M12 4.500v11M7.5 11 12 15.5 16.5 11M4.5 15.500v3a1.5 1.5 0 0 0 1.5 1.500h12a1.5 1.5 0 0 0 1.5-1.500v-3" />`,
  people: svg`<circle cx="9" cy="8.5" r="3.2" /><path d="M3 19.500c.3-3.6 2.7-5.5 6-5.500s5.7 1.9 6 5.500M15.5 5.600a3.2 3.2 0 0 1 0 5.800M17.5 14.400c2.1.7 3.3 2.4 3.5 5.1" />`,
  person: svg`<circle cx="12" cy="8.2" r="3.7" /><path d="M4.500 20c.4-4 3.3-6.200 7.500-6.200s7.100 2.200 7.500 6.200" />`,
  language: svg`<circle cx="12" cy="12" r="8.500" /><path d="M3.500 12h17M12 3.500c2.500 2.300 3.700 5.100 3.700 8.500s-1.200 6.200-3.700 8.500c-2.500-2.300-3.700-5.100-3.700-8.500s1.200-6.200 3.700-8.500Z" />`,
  book: svg`<path d="M12 6.500C10 5 7.500 4.500 4 4.500v13.500c3.500 0 6 .5 8 2 2-1.500 4.500-2 8-2V4.500c-3.500 0-6 .5-8 2ZM12 6.500V20" />`,
  leave: svg`<path d="M13.500 4.500h-7a1.500 1.500 0 0 0-1.500 1.500v12a1.500 1.500 0 0 0 1.500 1.500h7M10 12h10.500M16.500 8l4 4-4 4" />`,
  lock: svg`<rect x="5.5" y="10.500" width="13" height="9.500" rx="2" /><path d="M8.500 10.500V8a3.500 3.500 0 0 1 7 0v2.500M12 14.200v2.200" />`,
  unlock: svg`<rect x="5.5" y="10.500" width="13" height="9.500" rx="2" /><path d="M8.500 10.500V7.500a3.500 3.500 0 0 1 6.800-1.200M12 14.200v2.200" />`,
  shield: svg`<path d="M12 3.500 5 6v5.500c0 4.300 2.900 7.200 7 9 4.100-1.800 7-4.700 7-9V6Z" /><path d="M9.500 12.200l1.800 1.800 3.400-3.600" />`,
  search: svg`<circle cx="10.5" cy="10.5" r="6" /><path d="m15 15 5 5" />`,
  filter: svg`<path d="M4 5.500h16l-6.200 7.300v5.700l-3.600-2v-3.700Z" />`,
  copy: svg`<rect x="8.500" y="8.500" width="11.500" height="11.500" rx="2" /><path d="M15.500 5.500v-.5a1.500 1.500 0 0 0-1.500-1.500H5.500A1.500 1.500 0 0 0 4 5v8.500a1.500 1.500 0 0 0 1.500 1.500h.5" />`,
  link: svg`<path d="M10 14a4 4 0 0 0 5.700 0l3.300-3.300a4 4 0 0 0-5.700-5.700l-1 1M14 10a4 4 0 0 0-5.700 0L5 13.300a4 4 0 0 0 5.700 5.700l1-1" />`,
  drop: svg`<path d="M12 3.500s6 6.6 6 11a6 6 0 0 1-12 0c0-4.4 6-11 6-11Z" />`,
  section: svg`<path d="m12 3 8 4.500v9L12 21l-8-4.500v-9Z" stroke-dasharray="2.5 2.5" /><path d="M4 16.500 12 3l8 13.500Z" fill="currentColor" fill-opacity="0.25" />`,
  flip: svg`<path d="M12 3.500v17" stroke-dasharray="2.5 2.5" /><path d="M9 7 4 17h5ZM15 7l5 10h-5Z" />`,
  table: svg`<rect x="3.5" y="4.5" width="17" height="15" rx="2" /><path d="M3.5 9.500h17M3.5 14.500h17M9.500 9.500v10" />`,
  document: svg`<path d="M6.500 3.500h7.500l4 4v13h-11.500Z" /><path d="M13.500 3.500v4.500h4.500M9 12.500h6M9 16h6" />`,
  picture: svg`<rect x="3.5" y="4.5" width="17" height="15" rx="2" /><circle cx="9" cy="10" r="1.700" /><path d="m4 17.500 5-4.500 3 2.500 4-4.500 4.500 5" />`,
  bulb: svg`<path d="M9.500 17.500h5M10.200 20.500h3.600" /><path d="M9.500 17.500c0-2-3-3.600-3-7.300a5.500 5.500 0 0 1 11 0c0 3.700-3 5.300-3 7.300Z" />`,
  isolate: svg`<rect x="8" y="8" width="8" height="8" rx="1.5" fill="currentColor" /><path d="M4 7.500V4h3.500M16.500 4H20v3.500M20 16.500V20h-3.500M7.500 20H4v-3.500" />`,
  palette: svg`<path d="M12 3.500a8.500 8.500 0 1 0 0 17c1.300 0 1.900-.9 1.600-2-.4-1.300.3-2.500 1.800-2.500h2.100a3 3 0 0 0 3-3c0-5.300-3.800-9.500-8.500-9.500Z" /><path d="M7.500 12h.01M9.500 8h.01M14 7.500h.01M17 10.500h.01" stroke-width="2.6" />`,
  parts: svg`<path d="M4 20v-7h7v7ZM13 20v-7h7v7ZM8.500 11V4h7v7Z" />`,
  layers: svg`<path d="m12 4 8.500 4.500L12 13 3.500 8.500Z" /><path d="m4 12.500 8 4.200 8-4.200M4 16.500l8 4.200 8-4.200" />`,
  panel: svg`<rect x="3.5" y="4.5" width="17" height="15" rx="2" /><path d="M14.5 4.500v15" />`,
} satisfies Record<string, SVGTemplateResult>;

export type IconName = keyof typeof shapes;

export const icon = (name: IconName): TemplateResult =>
  html`<svg class="glyph" viewBox="0 0 24 24" aria-hidden="true">${shapes[name]}</svg>`;

export const logo =
  (): TemplateResult => html`<svg class="logo" viewBox="0 0 32 32" aria-hidden="true">
  <rect width="32" height="32" rx="7" fill="var(--logo-ground)" />
  <g fill="none" stroke-width="2.6" stroke-linecap="round">
    <path d="M5 11c4-3 7-3 11 0s7 3 11 0" stroke="var(--logo-top)" />
    <path d="M5 17c4-3 7-3 11 0s7 3 11 0" stroke="var(--logo-middle)" />
    <path d="M5 23c4-3 7-3 11 0s7 3 11 0" stroke="var(--logo-bottom)" />
  </g>
</svg>`;
