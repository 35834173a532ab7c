// Opens the page: the first frame is seen as soon as it is there, then the others are loaded.

async function open() {
  const film = new Film(JSON.parse(byId("header").textContent)), page = new Page(film);
  Object.assign(window.player, { page, film });
  await film.loadParticles();
  await film.loadBlock(0);
  connect(page);
  page.resize();
  page.drawNow();
  performance.mark("first frame");
  if (document.readyState == "loading")  // the other frames come after the script
    await new Promise(done => document.addEventListener("DOMContentLoaded", done, { once: true }));
  for (let block = 1; block < film.blocks; block++) {
    byId("message").textContent = `Loading ${Math.round(100 * film.loaded / film.times.length)} %`;
    await new Promise(resolve => setTimeout(resolve));
    await film.loadBlock(block);
  }
  for (let block = 0; block < film.nodeBlocks; block++) await film.loadNodes(block);
  page.draw();
  byId("message").hidden = true;
  byId("integrity").textContent = film.checksum == film.checksumWritten
    ? `Check sum ${film.checksum}: the frames are as they were written.`
    : `This file is damaged: check sum ${film.checksum} instead of ${film.checksumWritten}.`;
  window.player.checksum = film.checksum;
}

window.player = {};
window.player.ready = open().catch(error => {
  byId("message").hidden = false;
  byId("message").textContent = typeof DecompressionStream == "undefined"
    ? "This browser is too old for the player: it needs one of 2023 or later."
    : `The simulation cannot be shown: ${error.message ?? error}`;
  throw error;
});
