// Tables saved as a spreadsheet.

/** `lang`: the language of terms. */
export interface WorkbookQuery {
  f: "csv" | "xlsx";
  lang: string;
  separator: "comma" | "semicolon";
}
