// Bodies of numbers, errors in words, elements.

export const problem = async (answer) => {
  const text = await answer.text();
  try {
    const said = JSON.parse(text);
    const remedy = said.remedy && said.remedy[0].toUpperCase() + said.remedy.slice(1);
    return new Error(remedy ? `${said.error}. ${remedy}.` : `${said.error}.`);
  } catch {
    return new Error(text.slice(0, 300) || `The server answered ${answer.status}.`);
  }
};

// A body of `routes/arrays.rs`: a description, then arrays.
export const arrays = async (address, options) => {
  const answer = await fetch(address, options);
  if (!answer.ok) throw await problem(answer);
  const buffer = await answer.arrayBuffer();
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const data = {};
  let at = 4 + length;
  for (const part of head.arrays) {
    data[part.name] = new Float32Array(buffer, at, part.length);
    at += 4 * part.length;
  }
  return { meta: head.meta, data };
};

export const element = (name, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
};
