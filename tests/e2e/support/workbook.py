"""Reads an XLSX file with the standard library: the content that a spreadsheet would show, and the
content that it would run."""
import datetime
import io
import re
import xml.etree.ElementTree as xml
import zipfile

_MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_FIRST_DAY = datetime.datetime(1899, 12, 30)


class Workbook:
    def __init__(self, content):
        with zipfile.ZipFile(io.BytesIO(content)) as file:
            assert file.testzip() is None
            self.sheet = xml.fromstring(file.read("xl/worksheets/sheet1.xml"))
            self.styles = xml.fromstring(file.read("xl/styles.xml"))
            self.sheet_name = (
                xml.fromstring(file.read("xl/workbook.xml")).find(f".//{_MAIN}sheet").get("name")
            )
        self.formats = [int(f.get("numFmtId")) for f in self.styles.find(f"{_MAIN}cellXfs")]
        self.fonts = [int(f.get("fontId")) for f in self.styles.find(f"{_MAIN}cellXfs")]
        self.codes = {
            int(f.get("numFmtId")): f.get("formatCode") for f in self.styles.iter(f"{_MAIN}numFmt")
        }
        self.formulas = list(self.sheet.iter(f"{_MAIN}f"))
        # the width of the header, at most 26
        self.width = len(next(self.sheet.iter(f"{_MAIN}row")))
        self.rows = [self._row(row) for row in self.sheet.iter(f"{_MAIN}row")]

    def _row(self, row):
        cells = {}
        for cell in row:
            cells[re.match("[A-Z]+", cell.get("r")).group()] = self._value(cell)
        return [cells.get(chr(ord("A") + i)) for i in range(self.width)]

    def _value(self, cell):
        kind = cell.get("t", "n")
        if kind == "inlineStr":
            written = "".join(t.text or "" for t in cell.iter(f"{_MAIN}t"))
            # the escapes of ST_Xstring
            return re.sub("_x([0-9A-Fa-f]{4})_", lambda escape: chr(int(escape[1], 16)), written)
        text = cell.find(f"{_MAIN}v").text
        if kind == "b":
            return text == "1"
        assert kind == "n", kind
        code = self.codes.get(self.formats[int(cell.get("s", 0))], "")
        if "yyyy" not in code:
            return float(text)
        moment = _FIRST_DAY + datetime.timedelta(days=float(text))
        return (
            moment.replace(microsecond=0)
            + datetime.timedelta(milliseconds=round(moment.microsecond / 1000))
            if "hh" in code
            else moment.date()
        )

    @property
    def records(self):
        return [dict(zip(self.rows[0], row)) for row in self.rows[1:]]

    def head_is_bold_and_stays(self):
        bold = [font.find(f"{_MAIN}b") is not None for font in self.styles.find(f"{_MAIN}fonts")]
        first = next(self.sheet.iter(f"{_MAIN}row"))
        pane = self.sheet.find(f".//{_MAIN}pane")
        return all(bold[self.fonts[int(cell.get("s", 0))]] for cell in first) and (
            pane.get("state"),
            pane.get("ySplit"),
        ) == ("frozen", "1")

    @property
    def filtered(self):
        return self.sheet.find(f"{_MAIN}autoFilter").get("ref")
