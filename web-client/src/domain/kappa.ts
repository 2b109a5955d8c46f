// The meaning of Cohen's kappa in words.

export type KappaMeaning =
  "poor" | "slight" | "fair" | "moderate" | "substantial" | "almost_perfect";

/**
 * Returns the strength of agreement on the scale of Landis and Koch (1977). Its limits have two
 * decimals, such as 0.20 and 0.21, so kappa is rounded first.
 */
export function kappaMeaning(kappa: number): KappaMeaning {
  const hundredths = Math.round(kappa * 100);
  if (hundredths < 0) return "poor";
  if (hundredths <= 20) return "slight";
  if (hundredths <= 40) return "fair";
  if (hundredths <= 60) return "moderate";
  if (hundredths <= 80) return "substantial";
  return "almost_perfect";
}
