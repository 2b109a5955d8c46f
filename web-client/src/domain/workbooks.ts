// Parameters of requests that save tables as spreadsheets.

/** Query parameters. `lang` is the language of terms. */
export interface WorkbookQuery {
  f: "csv" | "xlsx";
  lang: string;
  separator: "comma" | "semicolon";
}
