/** WGSL of the network `recommended`: 7-32-16-1, 752 multiply-adds a fragment. */
export const recommended: string;
/** WGSL of the network `small`: 7-16-8-1, 248 multiply-adds a fragment. */
export const small: string;
/** WGSL of the network `moments-6`: 9-32-16-1, 816 multiply-adds a fragment. */
export const moments6: string;
