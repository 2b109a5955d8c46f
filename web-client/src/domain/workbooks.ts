// Tables that are saved for a spreadsheet.

/** `lang`: the language in which terms stand in it. */
export interface WorkbookQuery {
  f: "csv" | "xlsx";
  lang: string;
  separator: "comma" | "semicolon";
}
