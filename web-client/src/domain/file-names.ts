// Derives names from file names.

/**
 * Derives a model's name from its file name: "statue_nefertiti_70k.ply" → "statue nefertiti 70k".
 */
export function nameOfFile(filename: string): string {
  const stem = filename
    .replace(/\.[a-z0-9]{1,5}$/i, "")
    .replace(/_+/g, " ")
    .trim();
  return stem || filename;
}
