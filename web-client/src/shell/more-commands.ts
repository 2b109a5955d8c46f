// The commands without keys: for the model's content, and for the dialogs of the page.

import { labelOf } from "../domain/cells";
import { canBeColored } from "../domain/palette";
import { called } from "../domain/people";
import { mayAdminister, mayDownload } from "../core/types";
import { kCuts, kLightModes } from "../features/appearance/appearance";
import { texts } from "../texts";
import type { IconName } from "../ui/icons";
import { navigate } from "../ui/routes";
import { openTrashOf } from "../ui/trash-dialog";
import type { Command } from "./command";
import { changeProblem } from "./commands";
import type { OpenDialog, PageHost } from "./open-dialog";

export const moreCommands = (host: PageHost): Command[] => [
  ...ofLayers(host),
  ...ofSelectedLayer(host),
  ...ofViews(host),
  ...ofAppearance(host),
  ...ofPeople(host),
  ...ofModel(host),
  ...ofUser(host),
];

/** Returns a function that opens a dialog. */
const opening = (
  host: PageHost,
  group: string,
  glyph: IconName,
  title: string,
  dialog: OpenDialog,
): Command => ({
  id: `open.${dialog.dialog}`,
  group,
  title,
  glyph,
  run: () => host.show(dialog),
});

function ofLayers(host: PageHost): Command[] {
  const { session } = host;
  const { layers } = session;
  const words = texts.layers;
  const group = words.title;
  const ofEach = [...layers.all].reverse().flatMap((layer): Command[] => {
    const name = labelOf(layer);
    const visible = layers.visible(layer);
    return [
      {
        id: `layer.select.${layer.id}`,
        group,
        title: words.select(name),
        glyph: "layers",
        run: () => layers.select(layer),
      },
      {
        id: `layer.show.${layer.id}`,
        group,
        title: visible ? words.hide(name) : words.show(name),
        glyph: visible ? "eye_off" : "eye",
        run: () => layers.setVisible(layer, !visible),
      },
    ];
  });
  const reset: Command = {
    id: "layers.reset",
    group,
    title: words.reset_default,
    glyph: "layers",
    run: () => layers.resetOverrides(),
  };
  const shown = layers.hasOverrides ? [...ofEach, reset] : ofEach;
  if (!session.canCurate) return shown;
  return [
    ...shown,
    opening(host, group, "plus", words.new, { dialog: "create" }),
    opening(host, group, "layers", texts.templates.open, { dialog: "template" }),
    opening(host, group, "upload", texts.terms_dialog.open, {
      dialog: "terms",
      table: null,
      file: null,
    }),
    opening(host, group, "import", texts.transfer.open, { dialog: "transfer" }),
    {
      id: "open.trash",
      group,
      title: texts.bin.open,
      glyph: "trash",
      run: () => void openTrashOf(session),
    },
  ];
}

function ofSelectedLayer(host: PageHost): Command[] {
  const { session } = host;
  const layer = session.layers.selected;
  if (!layer) return [];
  const open = (
    glyph: IconName,
    text: string,
    dialog: "statistics" | "colors" | "where" | "edit" | "map" | "cleanup" | "pieces",
    problem?: string,
  ): Command => ({
    ...opening(host, texts.layers.title, glyph, `${labelOf(layer)}: ${text}`, { dialog, layer }),
    problem,
  });
  const locked = session.isLocked(layer) ? texts.layers.locked : undefined;
  const painting = changeProblem(session) ?? locked;
  return [
    open("chart", texts.layers.statistics, "statistics"),
    ...(canBeColored(layer) ? [open("palette", texts.colors.open, "colors")] : []),
    open("formula", texts.areas.where, "where", painting),
    open("upload", texts.layers.paint_file, "map", painting),
    open("eraser", texts.cleanup.open, "cleanup", painting),
    open("table", texts.cleanup.open_pieces, "pieces", changeProblem(session)),
    ...(session.canCurate ? [open("edit", texts.layers.edit, "edit")] : []),
  ];
}

function ofViews(host: PageHost): Command[] {
  const { session } = host;
  const { views, tours } = session;
  const words = texts.kept_views;
  const group = words.title;
  const kept = views.all.map((view): Command => ({
    id: `views.${view.id}`,
    group,
    title: view.name,
    glyph: "eye",
    run: () => void views.goTo(view),
  }));
  const save = opening(host, group, "plus", words.keep, { dialog: "view", view: null });
  const ofTours = [
    ...tours.all.map((tour) => ({ id: `tours.${tour.id}`, title: tour.name, tour })),
    { id: "tours.new", title: texts.tours.new, tour: null },
  ].map(({ id, title, tour }): Command => ({
    id,
    group: texts.tours.title,
    title,
    glyph: tour ? "play" : "plus",
    run: () => host.editTour(tour),
  }));
  return [...kept, ...(session.canPaint ? [save] : []), ...(session.canCurate ? ofTours : [])];
}

function ofAppearance(host: PageHost): Command[] {
  const { session } = host;
  const { appearance } = session;
  const words = texts.view;
  const lights = kLightModes.map((mode): Command => ({
    id: `light.${mode}`,
    group: words.title,
    title: `${words.light}: ${words.lights[mode]}`,
    glyph: "bulb",
    run: () => appearance.setLight({ mode }),
  }));
  const sections = [...kCuts, "box" as const].map((mode): Command => ({
    id: `section.${mode}`,
    group: words.section,
    title: words.section_hints[mode],
    glyph: "section",
    run: () => appearance.setSection({ mode }),
  }));
  const images = appearance.looks.map((look): Command => {
    const visible = appearance.visible(look);
    return {
      id: `look.${look.id}`,
      group: words.looks,
      title: visible ? texts.layers.hide(look.name) : texts.layers.show(look.name),
      glyph: "picture",
      run: () => appearance.setVisible(look, !visible),
    };
  });
  const add = opening(host, words.looks, "import", texts.orthophoto.open, { dialog: "orthophoto" });
  const reset: Command = {
    id: "view.reset",
    group: words.title,
    title: `${words.title}: ${words.reset}`,
    glyph: "eye",
    run: () => appearance.reset(),
  };
  return [
    ...lights,
    ...sections,
    ...images,
    ...(session.canCurate ? [add] : []),
    ...(appearance.isDefault ? [] : [reset]),
  ];
}

function ofPeople({ session }: PageHost): Command[] {
  const { together } = session;
  const words = texts.together;
  const group = texts.account.people.replace("…", "");
  const others = together.people.flatMap((person): Command[] => {
    const { viewer } = person;
    if (!viewer || !together.canFollow(person)) return [];
    return [
      {
        id: `follow.${person.user}`,
        group,
        title: person.own ? words.follow_own : words.follow(called(person)),
        glyph: "person",
        run: () => together.follow(viewer),
      },
    ];
  });
  const { leading } = together;
  if (others.length === 0 && !leading) return [];
  return [
    ...others,
    {
      id: "together.lead",
      group,
      title: leading ? words.stop_leading : words.lead,
      glyph: "people",
      run: () => together.lead(!leading),
    },
  ];
}

function ofModel(host: PageHost): Command[] {
  const { session } = host;
  const { model } = session;
  if (!model) return [];
  const group = model.name;
  return [
    opening(host, group, "info", texts.model.details, { dialog: "about" }),
    opening(host, texts.figures.title, "document", texts.figures.unroll, { dialog: "rollout" }),
    opening(host, texts.view.photographs, "picture", texts.view.open_photographs, {
      dialog: "photographs",
    }),
    opening(host, group, "document", texts.condition_report.open, { dialog: "report" }),
    ...(session.canCurate
      ? [opening(host, group, "table", texts.billing.open, { dialog: "bills" })]
      : []),
    ...(mayDownload(session.role, model)
      ? [opening(host, group, "cube", texts.model_export.open, { dialog: "export" })]
      : []),
    opening(host, group, "link", texts.gis.open, { dialog: "gis" }),
    opening(host, group, "link", texts.gis.linked, { dialog: "linked" }),
    ...(session.canCurate
      ? [opening(host, group, "measure", texts.model.correct_size, { dialog: "scale" })]
      : []),
    {
      id: "home",
      group,
      title: texts.model.back,
      glyph: "back",
      run: () => navigate("/"),
    },
  ];
}

function ofUser(host: PageHost): Command[] {
  const { me } = host;
  const words = texts.account;
  const group = called(me);
  const ask = (
    request: Parameters<PageHost["account"]>[0],
    glyph: IconName,
    title: string,
  ): Command => ({
    id: `account.${request}`,
    group,
    title,
    glyph,
    run: () => host.account(request),
  });
  return [
    ask("account", "person", words.open),
    ...(mayAdminister(me.role)
      ? [ask("people", "people", words.people), ask("nodes", "cloud", words.nodes)]
      : []),
    ...(host.seesToKiosks ? [ask("kiosks", "picture", texts.kiosks.open)] : []),
    ask("preferences", "language", texts.settings.open),
    {
      id: "guide",
      group: texts.help.title,
      title: texts.help.guide,
      glyph: "book",
      run: () => void window.open("/guide/", "_blank", "noopener"),
    },
    {
      id: "tour",
      group: texts.help.title,
      title: texts.tour.again,
      glyph: "help",
      run: () => host.startTour(),
    },
    ask("sign-out", "leave", words.sign_out),
  ];
}
