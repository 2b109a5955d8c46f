// Returns the comments of a source file: the text of the file with everything else replaced by
// blanks, so lines and columns stay the same.

const cLike = [".cpp", ".h", ".ts", ".mjs", ".js", ".comp", ".vert", ".frag", ".glsl", ".css"];
const hashLike = [".py", ".sh", ".cmake", ".yaml", ".yml", "CMakeLists.txt", "run", "test"];

export const kCommented = (kind) =>
  kind === ".sql" || cLike.includes(kind) || hashLike.includes(kind);

// Strings come first, because a `//` or `#` inside a string begins no comment.
const kStrings = /"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'/.source;
const kPatterns = {
  c: new RegExp(`${kStrings}|(//.*|/\\*[\\s\\S]*?\\*/)`, "g"),
  hash: new RegExp(`${kStrings}|((?<=^|\\s)#.*)`, "gm"),
  sql: new RegExp(`${kStrings}|(--.*)`, "g"),
};

const blank = (text) => text.replace(/[^\n]/g, " ");

export function commentsOf(source, kind) {
  const pattern =
    kind === ".sql" ? kPatterns.sql : cLike.includes(kind) ? kPatterns.c : kPatterns.hash;
  let out = "";
  let end = 0;
  for (const found of source.matchAll(pattern)) {
    out += blank(source.slice(end, found.index));
    end = found.index + found[0].length;
    // Omit code in grave accents, and the characters that begin the lines of a comment.
    out += found[1]
      ? found[1]
          .replace(/^(\s*)(\/\/+|\/?\*+\/?|#+|--+)/gm, (signs) => blank(signs))
          .replace(/\*+\/$/, blank)
          .replace(/`[^`\n]*`/g, blank)
      : blank(found[0]);
  }
  return out + blank(source.slice(end));
}
