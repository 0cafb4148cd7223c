// SPDX-License-Identifier: MIT
// The page of csgmesh view: asks for states one after the other and shows them.
let shownModel = 0, sending = 0;

host.setValues = (values) => {
  clearTimeout(sending);
  const body = definitions(values).join("\n");
  sending = setTimeout(() => fetch("set", { method: "POST", body }).catch(() => {}), 40);
};

host.file = async (format) => {
  const response = await fetch(`file?format=${encodeURIComponent(format)}`);
  if (!response.ok) throw new Error(await response.text());
  return response.blob();
};

async function newModel(number) {
  const response = number && number !== shownModel ? await fetch(`model?number=${number}`) : null;
  if (!response?.ok) return null;
  shownModel = number;
  return response.arrayBuffer();
}

async function take(state) {
  document.title = `${state.scene.name} - csgmesh view`;
  byId("name").textContent = state.scene.name;
  showState(state, await newModel(state.scene.model));
  document.body.dataset.shown = `${state.scene.phase} ${state.version}`;
}

async function follow() {
  let version = 0;
  for (;;) {
    try {
      const response = await fetch(`state?after=${version}`);
      if (response.status === 204) continue;
      if (!response.ok) throw new Error(await response.text());
      const state = await response.json();
      version = state.version;
      await take(state);
    } catch (error) {
      if (error instanceof TypeError) showStatus("csgmesh view has ended. Start it again and open its new address.", true);
      else showStatus(String(error.message ?? error), true);
      await new Promise((resolve) => setTimeout(resolve, 1000));
    }
  }
}

follow();
