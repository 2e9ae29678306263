// scroll_spy.ts — the navigation says which scene is on the screen.

/** Marks the link of the scene that crosses the upper third of the window, and keeps it in sight. */
export function followScroll(navigation: HTMLElement, sections: readonly HTMLElement[]): void {
  const links = new Map([...navigation.querySelectorAll("a")].map((link) => [link.getAttribute("href"), link]));
  const observer = new IntersectionObserver(
    (entries) => {
      for (const entry of entries) {
        const link = links.get(`#${entry.target.id}`);
        if (!link) continue;
        if (entry.isIntersecting) {
          link.setAttribute("aria-current", "true");
          const list = link.closest("ul");
          list?.scrollTo({ left: link.offsetLeft - list.offsetLeft - 16 });
        } else link.removeAttribute("aria-current");
      }
      if (!navigation.querySelector("[aria-current]") && window.scrollY < window.innerHeight) {
        navigation.querySelector("ul")?.scrollTo({ left: 0 });
      }
    },
    { rootMargin: "-25% 0px -74% 0px" },
  );
  for (const section of sections) observer.observe(section);
}
