// Elements, and their replacement by others of the same shape without losing focus, text that is
// being typed, or where somebody has scrolled to.

export type Child = Node | string | null | undefined | false;

/// `data-do` names what a click does (see main.ts); styles and handlers in attributes would be
/// refused by the page's own policy.
export function h(name: string, attributes: Record<string, string | number | boolean | null | undefined> = {},
    ...children: Child[]): HTMLElement {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes))
    if (value !== null && value !== undefined && value !== false) node.setAttribute(key, value === true ? '' : String(value));
  for (const child of children) if (child) node.append(child);
  return node;
}

export function svg(name: string, attributes: Record<string, string | number>, ...children: SVGElement[]): SVGElement {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, String(value));
  node.append(...children);
  return node;
}

const keyOf = (node: Node): string | null => node instanceof Element ? node.getAttribute('data-key') : null;

function sameKind(a: Node, b: Node): boolean {
  return a.nodeType === b.nodeType && a.nodeName === b.nodeName && keyOf(a) === keyOf(b);
}

function morphAttributes(old: Element, next: Element): void {
  for (const { name } of [...old.attributes])
    if (!next.hasAttribute(name) && !(old.nodeName === 'DETAILS' && name === 'open')) old.removeAttribute(name);
  for (const { name, value } of [...next.attributes])
    if (old.getAttribute(name) !== value) old.setAttribute(name, value);
}

/// Makes the children of `old` those of `next`, and keeps the nodes that stay. What has `data-keep`
/// is left as it is.
export function morph(old: Element, next: Element): void {
  const coming = [...next.childNodes];
  let at: ChildNode | null = old.firstChild;
  for (const node of coming) {
    const key = keyOf(node);
    let found: ChildNode | null = at && sameKind(at, node) ? at : null;
    if (!found && key !== null)
      found = [...old.childNodes].find(each => sameKind(each, node)) ?? null;
    if (!found) {
      old.insertBefore(node, at);
      continue;
    }
    if (found !== at) old.insertBefore(found, at);
    else at = at.nextSibling;
    if (found instanceof Element && node instanceof Element) {
      if (found.hasAttribute('data-keep')) continue;
      morphAttributes(found, node);
      morph(found, node);
    } else if (found.nodeValue !== node.nodeValue) {
      found.nodeValue = node.nodeValue;
    }
  }
  while (at) {
    const gone: ChildNode = at;
    at = at.nextSibling;
    gone.remove();
  }
}
