// The images, sounds and videos of a stop, in the visitor's language.

import type { KioskSelf, TourFile, TourStop } from "../core/protocol.gen";
import { asKiosk } from "./as-kiosk";
import { wordsIn } from "./languages";

export interface ShownMedium {
  id: number;
  kind: "picture" | "sound" | "video";
  url: string;
  /** The address of the thumbnail, for images. */
  thumbnail: string;
  /** The text alternative. If it is missing, this is the caption or the file name. */
  alt: string;
  caption: string;
  subtitles: { language: string; url: string }[];
}

/** Returns the address of a file of the tour. */
export const addressOfFile = (
  { model, tour }: Pick<KioskSelf, "model" | "tour">,
  id: number,
): string => asKiosk(`/api/v1/models/${encodeURIComponent(model)}/tours/${tour.id}/files/${id}`);
export const thumbnailOfFile = (self: Pick<KioskSelf, "model" | "tour">, id: number): string =>
  `${addressOfFile(self, id)}&thumbnail=512`;

/** Returns the media of the stop whose files exist. */
export function mediaOf(
  self: KioskSelf,
  { media = [] }: TourStop,
  language: string,
): ShownMedium[] {
  const { languages, files = [] } = self.tour;
  return media.flatMap(({ file: id, alt, caption, subtitles = {} }): ShownMedium[] => {
    const file = files.find((each) => each.id === id);
    if (!file || file.kind === "subtitles") return [];
    const words = wordsIn(caption, language, languages);
    return [
      {
        id,
        kind: file.kind,
        url: addressOfFile(self, id),
        thumbnail: thumbnailOfFile(self, id),
        alt: wordsIn(alt, language, languages) || words || nameWithoutEnding(file),
        caption: words,
        subtitles: Object.entries(subtitles).map(([tag, text]) => ({
          language: tag,
          url: addressOfFile(self, text),
        })),
      },
    ];
  });
}

const nameWithoutEnding = ({ name }: TourFile): string => name.replace(/\.[^.]{1,5}$/, "");
