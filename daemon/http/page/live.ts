// The stream of changes: tells when there is something new, and plainly when nothing can be heard.

export type Link = { state: 'connecting' | 'live' | 'polling' | 'lost'; since: number };

const kSilence = 8000; // ms; the monitor says something every three seconds
const kRetry = 2000;
const kLook = 1000;

export function listen(onNews: () => void, onLink: (link: Link) => void): void {
  let source: EventSource | null = null;
  let heard = Date.now();
  let link: Link = { state: 'connecting', since: Date.now() };
  let retry = 0;

  const become = (state: Link['state']) => {
    if (link.state === state) return;
    link = { state, since: state === 'lost' ? heard : Date.now() };
    onLink(link);
  };
  const hear = () => {
    heard = Date.now();
    become('live');
  };
  const open = () => {
    source?.close();
    source = new EventSource('/api/v1/events');
    source.addEventListener('state', () => {
      hear();
      onNews();
    });
    source.addEventListener('alive', hear);
  };
  // A browser tries again by itself, but not where the monitor refuses the stream: it serves a
  // bounded number of pages live, and the others read now and then.
  const look = async () => {
    if (Date.now() - heard < kSilence && source?.readyState !== EventSource.CLOSED) return;
    if (Date.now() < retry) return;
    retry = Date.now() + kRetry;
    try {
      const answer = await fetch('/healthz', { cache: 'no-store', signal: AbortSignal.timeout(kRetry) });
      if (!answer.ok) throw new Error();
      if (source?.readyState === EventSource.CLOSED) become('polling');
      onNews();
    } catch {
      become('lost');
    }
    open();
  };
  open();
  onLink(link);
  setInterval(() => {
    // A connection that was cut is known at once; one that only falls silent after a while.
    if (source?.readyState === EventSource.CONNECTING && link.state === 'live' && Date.now() - heard > kRetry) become('lost');
    void look();
  }, kLook);
}
