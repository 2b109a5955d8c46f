// The rows of the help in Spanish.

import type { HelpTexts } from "./shape";

export const help: HelpTexts = {
  key_names:
    "Ctrl · Mayús · Intro · Esc · Retroceso · Supr · Tab · Espacio · Flechas · Arriba · Abajo · Izquierda · Derecha · Re Pág · Av Pág · Inicio · Fin · F2",
  mouse: "Ratón",
  touch: "Pantalla táctil",
  mouse_rows: [
    ["Arrastrar con el izquierdo", "usar la herramienta activa"],
    [
      "Detener el puntero (Girar, Desplazar)",
      "ver por encima el registro que hay allí; Esc lo cierra",
    ],
    ["Clic (Girar, Desplazar)", "abrir el registro que hay allí"],
    ["Arrastrar con el derecho, o Espacio + izquierdo", "girar"],
    ["Arrastrar con el central, o Mayús + derecho", "desplazar"],
    ["Rueda", "acercar o alejar donde está el puntero"],
  ],
  touch_rows: [
    ["Un dedo", "usar la herramienta activa"],
    ["Tocar (Girar, Desplazar)", "abrir el registro que hay allí"],
    ["Dos dedos", "arrastrar para desplazar, pellizcar para acercar o alejar, torcer para rotar"],
    ["Tocar con Medir", "poner un punto; arrastrar para girar"],
    [
      "Lápiz",
      "usar la herramienta activa; se ignoran la mano y los dedos mientras el lápiz está cerca",
    ],
    ["Un dedo después de usar un lápiz", "girar, incluso con una herramienta de pintura o dibujo"],
  ],
  tool_keys: "Con una herramienta activa",
  tool_rows: [
    [
      "Intro · Retroceso · Esc",
      "terminar el polígono o la línea · quitar el último vértice · cancelar",
    ],
    [
      "Mayús + A",
      "ajustar el polígono o la línea a bordes y grietas, o dejar de hacerlo; cada clic fija el trazo mostrado",
    ],
    [
      "Mayús + L y trazos",
      "seleccionar una zona con trazos dentro y, con Alt, fuera; Mayús + L: el otro lado; Ctrl + Z: deshacer un trazo; Intro: aceptar la zona",
    ],
    [
      "Polígono, lazo o varita con Mayús · Alt",
      "añadir a la selección · restar de ella; ambas: intersecar; Retroceso quita la última parte, Intro rellena, Esc descarta",
    ],
    ["C, y después clic", "comentar allí; Intro: en el centro de la vista"],
    ["Ctrl + Intro · Esc", "enviar el comentario · cerrarlo y conservarlo sin enviar"],
    [
      "M, y después clic",
      "medir longitudes, áreas y perfiles; M otra vez: un punto en el centro; Intro termina, Esc borra",
    ],
    [
      "I, y después clic",
      "en una capa de registros: abrir el registro que hay allí y pintar con él",
    ],
  ],
  table: "En la tabla de registros",
  table_rows: [
    ["Flechas · Re Pág · Av Pág · Inicio · Fin", "moverse entre celdas; con Ctrl: primera, última"],
    ["Intro, F2 u otro clic", "editar la celda; en la clave: abrir el formulario del registro"],
    [
      "Letras y cifras",
      "escribir en celdas de texto; las cifras, también en números, fechas y horas; en las demás celdas son teclas de la página, como T, D y V; después de Esc, siempre",
    ],
    [
      "Embudo de una columna",
      "filtrar por valores, un intervalo, un texto o valores que faltan; el campo del filtro muestra la condición",
    ],
    [
      "Intro · Tab · Esc",
      "al editar: abajo · celda siguiente · cancelar; Mayús + Intro: línea nueva",
    ],
    ["Supr", "vaciar la celda"],
    [
      "Espacio, o clic en una clave",
      "seleccionar la fila; con Ctrl: más filas, con Mayús: un intervalo",
    ],
    ["Ctrl + Z · Ctrl + Mayús + Z", "deshacer · rehacer sus cambios en la tabla"],
    [
      "⋯ de una columna → Cambiar",
      "cambiar su nombre, también en otros idiomas; cada usuario ve el idioma de su navegador",
    ],
    [
      "Soltar un CSV",
      "ver los cambios antes de importarlos; en una lista de términos, también SKOS",
    ],
  ],
  brush: "Opciones del pincel",
  brush_rows: [
    [
      "Forma",
      "redonda, cuadrada o una imagen: elija + o suelte un PNG o JPEG junto a las formas; todas las personas del servidor las comparten",
    ],
    [
      "Omitir superficies inclinadas más de",
      "omite las superficies que se ven muy de lado; gire para pintarlas",
    ],
    ["Pintar a través del objeto", "pinta también las superficies ocultas"],
  ],
  terms: "En una lista de términos",
  terms_rows: [
    ["Escribir", "buscar términos por nombre, en todos los idiomas"],
    ["Arriba · Abajo · Re Pág · Av Pág", "moverse entre términos"],
    ["Derecha · Izquierda", "desplegar · contraer"],
    ["Intro", "pintar con el término"],
    ["Esc", "mostrar la lista entera; otra vez: volver al modelo"],
  ],
  layers: "Capas sin pincel",
  layer_rows: [
    [
      "Capas ⋯ → A partir de una plantilla",
      "listas de términos, tablas y capas para piedra, pintura mural, excavación y tratamiento",
    ],
    [
      "Capas ⋯ → Importar una lista de términos",
      "CSV o SKOS (Turtle, RDF/XML), con vista previa; actualice y exporte una lista en el ⋯ de su tabla",
    ],
    [
      "⋯ de una capa → Pintar desde un archivo",
      "valores medidos, mapas, shapefiles, GeoTIFF y mapas escaneados; números para los vértices del escaneo",
    ],
    [
      "Vista → Imágenes de la superficie → Añadir una ortofoto",
      "proyectar una imagen sobre la superficie",
    ],
    [
      "⋯ de una capa → Áreas",
      "áreas de las clases; en mediciones, un histograma que fija el intervalo de los colores",
    ],
    [
      "Nueva capa → A partir de una expresión",
      "valores calculados a partir de otras capas, sus registros y la superficie",
    ],
    [
      "Nueva capa → A partir de la geometría",
      "valores calculados a partir de la malla: curvatura, pendiente, distancias",
    ],
    [
      "Capas ⋯ → Transferir capas",
      "lo pintado en un escaneo anterior del objeto, con un informe de lo perdido",
    ],
    [
      "Vista → Recorridos",
      "vistas guardadas con textos en varios idiomas, para una pantalla de una exposición; enlaces para quioscos en el ⋯ de un recorrido",
    ],
    [
      "Vista → Mediciones",
      "partidas que cuentan áreas, longitudes y registros según reglas; Arriba · Abajo mueven, Derecha · Izquierda abren y cierran grupos, Intro edita, Insert añade, Supr quita",
    ],
    [
      "Partes, sobre la vista 3D",
      "mostrar y ocultar los escaneos de un modelo importado de varios",
    ],
  ],
};
