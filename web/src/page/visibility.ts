// visibility.ts — work is done when it comes into view (or is printed), not before.

/** Calls `then` once, when the element first comes near the screen or the page is printed; returns how to cancel. */
export function whenVisible(element: Element, then: () => void): () => void {
  const observer = new IntersectionObserver(
    (entries) => {
      if (entries.some((entry) => entry.isIntersecting)) run();
    },
    { rootMargin: "300px" },
  );
  const stop = () => {
    observer.disconnect();
    window.removeEventListener("beforeprint", run);
  };
  const run = () => {
    stop();
    then();
  };
  observer.observe(element);
  window.addEventListener("beforeprint", run);
  return stop;
}

/** Calls `changed` with whether the element is on the screen, at each change. */
export function watchVisibility(element: Element, changed: (visible: boolean) => void): () => void {
  const observer = new IntersectionObserver((entries) => changed(entries.some((entry) => entry.isIntersecting)));
  observer.observe(element);
  return () => observer.disconnect();
}
