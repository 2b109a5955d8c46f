import { pageLanguage } from "../core/locale";
import { chosenLanguage, followTheme } from "../ui/preferences";
import { isKiosk } from "../ui/routes";
import { loadTexts } from "../texts";

async function start(): Promise<void> {
  if (isKiosk(location.pathname)) return (await import("../kiosk/main")).startKiosk();
  followTheme();
  const chosen = chosenLanguage();
  const language = pageLanguage(chosen, navigator.languages);
  document.documentElement.lang = language;
  await loadTexts(language, chosen !== null, navigator.languages);
  await import("./strata-app"); // its modules read the texts when they are loaded
}

void start();
