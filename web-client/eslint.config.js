// Lint rules that find mistakes in the page and its tests. Prettier alone formats the code.
import eslint from "@eslint/js";
import tseslint from "typescript-eslint";

export default tseslint.config(
  {
    ignores: ["dist/**", "node_modules/**", "src/core/protocol.gen.ts", "src/net/contract.gen.ts"],
  },
  eslint.configs.recommended,
  {
    files: ["**/*.ts"],
    extends: [tseslint.configs.recommended],
    languageOptions: { parserOptions: { projectService: true } },
    rules: {
      "@typescript-eslint/await-thenable": "error",
      "@typescript-eslint/consistent-type-imports": [
        "error",
        { fixStyle: "inline-type-imports", disallowTypeAnnotations: false },
      ],
      // Data have the names that the contract and the texts use, so properties of types and of
      // object literals may have underscores.
      "@typescript-eslint/naming-convention": [
        "error",
        {
          selector: ["variable", "parameter", "function"],
          format: ["camelCase", "PascalCase"],
          leadingUnderscore: "allow",
          filter: { regex: "^_+$", match: false }, // unused parameters
        },
        {
          selector: ["classProperty", "parameterProperty", "classMethod", "classicAccessor"],
          format: ["camelCase"],
          leadingUnderscore: "allow",
        },
        { selector: "typeLike", format: ["PascalCase"] },
      ],
      "@typescript-eslint/no-floating-promises": "error",
      "@typescript-eslint/no-misused-promises": ["error", { checksVoidReturn: false }],
      "@typescript-eslint/no-unnecessary-type-assertion": "error",
      "@typescript-eslint/no-unused-vars": [
        "error",
        { argsIgnorePattern: "^_", varsIgnorePattern: "^_", ignoreRestSiblings: true },
      ],
      "@typescript-eslint/only-throw-error": "error",
      "@typescript-eslint/switch-exhaustiveness-check": [
        "error",
        { considerDefaultExhaustiveForUnions: true },
      ],
    },
  },
  {
    files: ["src/**/*.ts"],
    rules: { "no-console": ["error", { allow: ["info", "warn", "error"] }] },
  },
  {
    rules: { eqeqeq: ["error", "always", { null: "ignore" }], "prefer-const": "error" },
  },
);
