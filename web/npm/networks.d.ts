/** WGSL of the network `recommended`: 7-32-16-1, 752 multiply-adds a fragment. */
export const recommended: string;
/** WGSL of the network `small`: 7-16-8-1, 248 multiply-adds a fragment. */
export const small: string;
/** WGSL of the network `moments-6`: 9-32-16-1, 816 multiply-adds a fragment. */
export const moments6: string;
/** WGSL of both passes with the network `ends`: 9-32-16-1, 816 multiply-adds a fragment. */
export const ends: string;
/** WGSL of both passes with the network `core-small`: 9-14-8-1, 246 multiply-adds a fragment. */
export const coreSmall: string;
/** WGSL of both passes with the network `core`: 9-32-16-1, 816 multiply-adds a fragment. */
export const core: string;
/** WGSL of both passes with the network `core-large`: 9-32-16-1, 816 multiply-adds a fragment. */
export const coreLarge: string;
