// The formulas of hand measurements, computed without rounding errors as the server does
// (server/bill/formula.h).

const kMaxLength = 500;
const kMaxDepth = 50;
const kMaxDigits = 30;
const kPlaces = 6;
const kLimit = 1n << 127n;

/** A number without rounding errors. The denominator is positive. */
interface Fraction {
  top: bigint;
  bottom: bigint;
}

/** The value with at most 6 decimal places and a point, or the problem with the formula. */
export type FormulaResult = { value: string } | { problem: "mistake" | "no_result"; at: number };

/** Thrown within this module. */
class Mistake extends Error {
  constructor(readonly problem: "mistake" | "no_result") {
    super(problem);
  }
}

const amount = (value: bigint): bigint => (value < 0n ? -value : value);

function fraction(top: bigint, bottom: bigint): Fraction {
  if (bottom === 0n) throw new Mistake("no_result");
  let [a, b] = [amount(top), amount(bottom)];
  while (b !== 0n) [a, b] = [b, a % b];
  const sign = bottom < 0n ? -1n : 1n;
  const found = { top: (sign * top) / (a || 1n), bottom: amount(bottom) / (a || 1n) };
  // The server also refuses larger numbers.
  if (amount(found.top) >= kLimit || found.bottom >= kLimit) throw new Mistake("no_result");
  return found;
}

const plus = (a: Fraction, b: Fraction): Fraction =>
  fraction(a.top * b.bottom + b.top * a.bottom, a.bottom * b.bottom);
const times = (a: Fraction, b: Fraction): Fraction => fraction(a.top * b.top, a.bottom * b.bottom);
const negative = ({ top, bottom }: Fraction): Fraction => ({ top: -top, bottom });
const inverse = ({ top, bottom }: Fraction): Fraction => fraction(bottom, top);

class Reader {
  at = 0;

  constructor(private readonly _text: string) {}

  read(): Fraction {
    const value = this.sum(0);
    this.take("=");
    this.skipSpaces();
    if (this.at < this._text.length) throw new Mistake("mistake");
    return value;
  }

  private sum(depth: number): Fraction {
    let value = this.product(depth);
    for (;;) {
      const isMinus = this.take("-", "−", "–");
      if (!isMinus && !this.take("+")) return value;
      const next = this.product(depth);
      value = plus(value, isMinus ? negative(next) : next);
    }
  }

  private product(depth: number): Fraction {
    let value = this.signedPower(depth);
    for (;;) {
      const isTimes = this.take("*", "x", "X", "×", "·");
      if (!isTimes && !this.take("/", ":", "÷")) return value;
      const next = this.signedPower(depth);
      value = times(value, isTimes ? next : inverse(next));
    }
  }

  private signedPower(depth: number): Fraction {
    if (depth > kMaxDepth) throw new Mistake("mistake");
    if (this.take("-", "−")) return negative(this.signedPower(depth + 1));
    const base = this.primary(depth);
    let power: Fraction = { top: 1n, bottom: 1n };
    for (let left = this.exponent(); left > 0; left -= 1) power = times(power, base);
    return power;
  }

  private exponent(): number {
    if (this.take("²")) return 2;
    if (this.take("³")) return 3;
    if (!this.take("^")) return 1;
    this.skipSpaces();
    const digit = this._text[this.at] ?? "";
    if (!/^\d$/.test(digit)) throw new Mistake("mistake");
    this.at += 1;
    return Number(digit);
  }

  private primary(depth: number): Fraction {
    if (this.take("(")) {
      const value = this.sum(depth + 1);
      if (!this.take(")")) throw new Mistake("mistake");
      return value;
    }
    this.skipSpaces();
    const typed = /^[\d.,]*/.exec(this._text.slice(this.at))![0];
    const parts = /^(\d+)(?:[.,](\d+))?$/.exec(typed);
    const [whole = "", places = ""] = parts?.slice(1) ?? [];
    if (!parts || whole.length + places.length > kMaxDigits) throw new Mistake("mistake");
    this.at += typed.length;
    return fraction(BigInt(whole + places), 10n ** BigInt(places.length));
  }

  private take(...symbols: string[]): boolean {
    this.skipSpaces();
    const found = symbols.find((symbol) => this._text.startsWith(symbol, this.at));
    this.at += found?.length ?? 0;
    return found !== undefined;
  }

  private skipSpaces(): void {
    while (/[ \t]/.test(this._text[this.at] ?? "")) this.at += 1;
  }
}

/** Rounds half up, without the sign, and removes zeros at the end. */
function textOf({ top, bottom }: Fraction): string {
  const unit = 10n ** BigInt(kPlaces);
  const rounded = (amount(top) * unit * 2n + bottom) / (bottom * 2n);
  const places = (rounded % unit).toString().padStart(kPlaces, "0").replace(/0+$/, "");
  const sign = top < 0n && rounded > 0n ? "-" : "";
  return `${sign}${rounded / unit}${places ? `.${places}` : ""}`;
}

/** Computes a formula such as "2 * 1,20 * 0,85". `at` is the place of the mistake. */
export function formulaResult(text: string): FormulaResult {
  const reader = new Reader(text);
  try {
    if (new TextEncoder().encode(text).length > kMaxLength) throw new Mistake("no_result");
    return { value: textOf(reader.read()) };
  } catch (error) {
    if (!(error instanceof Mistake)) throw error;
    return { problem: error.problem, at: reader.at };
  }
}
