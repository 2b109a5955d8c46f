// Stands for what Redoc reads other kinds of contracts with: several files, YAML, Swagger 2. Ours
// is one file of JSON.
function unused(): never {
  throw new Error("Only one kind of contract is read here.");
}
export const bundle = unused;
export const bundleFromString = unused;
export const bundleDocument = unused;
export class Config {}
export default unused;
