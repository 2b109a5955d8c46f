// Replaces the modules with which Redoc reads other kinds of contracts: several files, YAML,
// Swagger 2. Our contract is one JSON file.
function unused(): never {
  throw new Error("Only one kind of contract is read here.");
}
export const bundle = unused;
export const bundleFromString = unused;
export const bundleDocument = unused;
export class Config {}
export default unused;
